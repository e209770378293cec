#include "platform/base/event.hpp"

#include <gtest/gtest.h>

namespace gannet {
namespace {

TEST(EventPort, hands_events_over_in_order) {
  EventPort sut(4);
  sut.raise({.code = EventCode(3), .severity = Severity::kError, .args = {1.5, 0, -2}});
  sut.raise({.code = EventCode(4)});
  Event event;
  ASSERT_TRUE(sut.take(event));
  EXPECT_EQ(event.code, EventCode(3));
  EXPECT_EQ(event.args[2], -2);
  ASSERT_TRUE(sut.take(event));
  EXPECT_EQ(event.code, EventCode(4));
  EXPECT_FALSE(sut.take(event));
}

TEST(EventPort, counts_what_it_could_not_hold_and_keeps_the_oldest) {
  EventPort sut(2);
  for (int i = 0; i < 5; ++i) sut.raise({.code = EventCode(i)});
  EXPECT_EQ(sut.lost(), 3u);
  Event event;
  ASSERT_TRUE(sut.take(event));
  EXPECT_EQ(event.code, EventCode(0));
}

}  // namespace
}  // namespace gannet

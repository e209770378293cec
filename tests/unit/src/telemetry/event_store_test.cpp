#include "src/telemetry/event_store.hpp"

#include <gtest/gtest.h>

namespace gannet::telemetry {
namespace {

TEST(EventStore, keeps_the_newest_and_their_numbers) {
  EventStore sut(3);
  for (int i = 0; i < 5; ++i) sut.add({.code = EventCode(i)});
  EXPECT_EQ(sut.count(), 5u);
  ASSERT_EQ(sut.entries().size(), 3u);
  EXPECT_EQ(sut.entries().front().number, 3u);
  EXPECT_EQ(sut.entries().back().event.code, EventCode(4));
}

}  // namespace
}  // namespace gannet::telemetry

#include "src/world/action.hpp"

#include <gtest/gtest.h>

namespace gannet::world {
namespace {

TEST(Action, reads_every_kind_of_line) {
  const auto press = parse_action("  press   estop ");
  ASSERT_TRUE(press);
  EXPECT_EQ(press->verb, Verb::kPressEstop);
  EXPECT_EQ(press->text, "press estop");

  const auto target = parse_action("target crab");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->name, "crab");
  EXPECT_TRUE(target->is_operator_command());

  const auto current = parse_action("current 100 -20.5 0");
  ASSERT_TRUE(current);
  EXPECT_EQ(current->numbers, (std::vector<double>{100, -20.5, 0}));
  EXPECT_FALSE(current->is_operator_command());

  const auto drive = parse_action("silence drive 3");
  ASSERT_TRUE(drive);
  EXPECT_EQ(drive->verb, Verb::kSilenceDrive);
  EXPECT_EQ(drive->numbers, (std::vector<double>{3}));
}

TEST(Action, refuses_what_it_does_not_know) {
  for (const char* text : {"", "press", "press button", "goal 1 2", "goal a b c", "arm now",
                           "silence drive", "target", "light bright"}) {
    const auto action = parse_action(text);
    ASSERT_FALSE(action) << text;
    EXPECT_NE(action.error().text.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace gannet::world

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

TEST(Action, reads_what_its_own_list_says) {
  for (const ActionForm& form : action_forms()) {
    std::string line(form.words);
    for (const std::string& argument : words_of(form.arguments))
      line += argument == "NAME" ? " crab" : " 3";
    const auto action = parse_action(line);
    ASSERT_TRUE(action) << line;
    EXPECT_EQ(action->verb, form.verb) << line;
    EXPECT_EQ(action->text, line);
    EXPECT_EQ(action->numbers.size() + !action->name.empty(), words_of(form.arguments).size());
  }
  const auto late = parse_action("late drive 3 15");
  ASSERT_TRUE(late);
  EXPECT_EQ(late->numbers, (std::vector<double>{3, 15}));
}

TEST(Action, refuses_what_it_does_not_know) {
  for (const char* text :
       {"", "press", "press button", "goal 1 2", "goal a b c", "arm now", "silence drive", "target",
        "light bright", "late left", "late middle 15", "bus sideways"}) {
    const auto action = parse_action(text);
    ASSERT_FALSE(action) << text;
    EXPECT_NE(action.error().text.find(text), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace gannet::world

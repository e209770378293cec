#include "src/telemetry/event_codes.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace gannet::telemetry {
namespace {

std::string no_words(std::string_view, int) { return ""; }

TEST(EventCodes, each_has_one_code_and_one_name) {
  std::set<int> codes;
  std::set<std::string> names;
  for (const EventWords& words : event_table()) {
    EXPECT_TRUE(codes.insert(static_cast<int>(words.code)).second) << words.name;
    EXPECT_TRUE(names.insert(words.name).second) << words.name;
  }
}

TEST(EventCodes, every_text_can_be_made) {
  for (const EventWords& words : event_table()) {
    const std::string text = text_of(make_event(words.code, {}, 1, 2, 3), no_words);
    EXPECT_FALSE(text.empty());
    EXPECT_EQ(text.find('{'), std::string::npos) << text;
  }
}

TEST(EventCodes, numbers_and_words_take_their_places) {
  const Event event = make_event(kStateChanged, time_from_ns(5), 1, 2, 7);
  EXPECT_EQ(event.severity, Severity::kNotice);
  const std::string text = text_of(event, [](std::string_view kind, int value) {
    return std::string(kind) + std::to_string(value);
  });
  EXPECT_EQ(text, "state1 → state2 (cause7)");
  EXPECT_EQ(text_of(make_event(kGoalSet, {}, -1.5, 0, 500), no_words), "goal [-1.5, 0, 500] mm");
}

TEST(EventCodes, an_unknown_code_still_has_a_text) {
  EXPECT_EQ(text_of({.code = EventCode(999)}, no_words), "event 999");
}

}  // namespace
}  // namespace gannet::telemetry

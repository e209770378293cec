#include "src/control/protocol.hpp"

#include <gtest/gtest.h>

#include "platform/base/random.hpp"

namespace gannet::control {
namespace {

ErrorCode code_of(std::string_view line) {
  const auto parsed = parse_request(line);
  EXPECT_TRUE(std::holds_alternative<BadRequest>(parsed)) << line;
  return std::get<BadRequest>(parsed).failure.code;
}

TEST(Protocol, a_request_goes_there_and_back) {
  const Request sent{42, "goal", Json{{"mm", {0, 0, 500}}}};
  const auto parsed = parse_request(request_line(sent));
  ASSERT_TRUE(std::holds_alternative<Request>(parsed));
  const Request& got = std::get<Request>(parsed);
  EXPECT_EQ(got.id, 42);
  EXPECT_EQ(got.method, "goal");
  EXPECT_EQ(got.params["mm"][2], 500);
}

TEST(Protocol, each_mistake_has_its_code) {
  EXPECT_EQ(code_of(""), ErrorCode::kBadJson);
  EXPECT_EQ(code_of("{"), ErrorCode::kBadJson);
  EXPECT_EQ(code_of("[1]"), ErrorCode::kBadJson);
  EXPECT_EQ(code_of(R"({"id": 1, "method": "status"})"), ErrorCode::kBadProtocol);
  EXPECT_EQ(code_of(R"({"protocol": 2, "id": 1, "method": "status"})"), ErrorCode::kBadProtocol);
  EXPECT_EQ(code_of(R"({"protocol": 1, "method": "status"})"), ErrorCode::kBadRequest);
  EXPECT_EQ(code_of(R"({"protocol": 1, "id": {}, "method": "status"})"), ErrorCode::kBadRequest);
  EXPECT_EQ(code_of(R"({"protocol": 1, "id": 1})"), ErrorCode::kBadRequest);
  EXPECT_EQ(code_of(R"({"protocol": 1, "id": 1, "method": 3})"), ErrorCode::kBadRequest);
  EXPECT_EQ(code_of(R"({"protocol": 1, "id": 1, "method": "x", "params": 3})"),
            ErrorCode::kBadRequest);
  EXPECT_EQ(code_of(R"({"protocol": 1, "id": 1, "method": "x", "parms": {}})"),
            ErrorCode::kBadRequest);
}

TEST(Protocol, an_error_carries_the_id_back_where_it_could_be_read) {
  const auto parsed = parse_request(R"({"protocol": 1, "id": "a", "method": 3})");
  EXPECT_EQ(std::get<BadRequest>(parsed).id, "a");
  const std::string line = answer_line("a", Failure{ErrorCode::kRefused, "no vehicle", "none"});
  EXPECT_EQ(
      line,
      R"({"protocol":1,"id":"a","error":{"code":"refused","reason":"none","text":"no vehicle"}})"
      "\n");
}

TEST(Protocol, random_bytes_never_pass_and_never_crash) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string junk(static_cast<std::size_t>(random.below(60)), ' ');
    for (char& c : junk) c = static_cast<char>(random.below(256));
    EXPECT_TRUE(std::holds_alternative<BadRequest>(parse_request(junk)));
  }
}

TEST(Protocol, survives_deep_nesting_and_text_that_is_no_utf8) {
  const std::string deep = std::string(30000, '[') + std::string(30000, ']');
  EXPECT_EQ(code_of(deep), ErrorCode::kBadJson);
  const std::string line = answer_line(1, Failure{ErrorCode::kBadParams, "name \xff\xfe"});
  EXPECT_TRUE(Json::parse(line, nullptr, false).is_object());
}

}  // namespace
}  // namespace gannet::control

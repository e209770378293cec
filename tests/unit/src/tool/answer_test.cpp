#include "src/tool/answer.hpp"

#include <gtest/gtest.h>

namespace gannet::tool {
namespace {

Answer found_answer() {
  Answer answer;
  track::Recognition& r = answer.recognition;
  r.found = true;
  r.reason = TrackReason::kNone;
  // Turned by more than half a turn, so that w is negative as it stands.
  r.left_from_target.rotation = Eigen::Quaterniond(-0.8, 0, 0, 0.6);
  r.left_from_target.translation = {0.1, -0.2, 0.5};
  r.covariance.diagonal() << 1e-6, 4e-6, 9e-6, 1e-4, 4e-4, 9e-4;
  r.size_m = {0.175, 0.14};
  r.fitness = 0.75;
  r.evaluations = 20000;
  answer.time_ms = 12.5;
  answer.model = "crab";
  return answer;
}

TEST(Answer, json_has_the_contract_s_fields_in_their_units) {
  EXPECT_EQ(json_of(found_answer()).dump(),
            R"({"found":true,"position_m":[0.1,-0.2,0.5],"quaternion":[0.8,0.0,0.0,-0.6],)"
            R"("sigma_m":[0.001,0.002,0.003],"sigma_rad":[0.01,0.02,0.03],"fitness":0.75,)"
            R"("size_m":[0.175,0.14],"evaluations":20000.0,"time_ms":12.5,"model":"crab"})");
}

TEST(Answer, pose_fields_are_null_when_nothing_was_found) {
  Answer answer = found_answer();
  answer.recognition.found = false;
  const control::Json json = json_of(answer);
  for (const char* field : {"position_m", "quaternion", "sigma_m", "sigma_rad"})
    EXPECT_TRUE(json.at(field).is_null()) << field;
  EXPECT_EQ(json.at("found"), false);
  EXPECT_EQ(json.at("fitness"), 0.75);
  EXPECT_EQ(json.at("size_m").size(), 2u);
  answer.model.reset();
  EXPECT_TRUE(json_of(answer).at("size_m").is_null()) << "a rectangle's size follows from its pose";
}

TEST(Answer, a_negative_zero_is_printed_as_zero) {
  Answer answer = found_answer();
  answer.recognition.left_from_target.rotation = Eigen::Quaterniond(0.8, -0.0, 0.6, -0.0);
  answer.recognition.left_from_target.translation = {-0.0, -0.0, 0.5};
  const std::string sut = json_of(answer).dump();
  EXPECT_EQ(sut.find("-0.0"), std::string::npos) << sut;
}

TEST(Answer, text_is_in_millimetres_and_degrees) {
  const std::string text = text_of(found_answer());
  EXPECT_NE(text.find("100.0, -200.0, 500.0 mm  (±1.0, 2.0, 3.0)"), std::string::npos) << text;
  EXPECT_NE(text.find("175.0 x 140.0 mm"), std::string::npos) << text;
  Answer answer = found_answer();
  answer.recognition.found = false;
  EXPECT_EQ(text_of(answer).substr(0, 9), "not found");
}

TEST(Answer, an_error_is_one_object_whatever_its_text) {
  EXPECT_EQ(json_of_error("a \"b\"\nc").dump(), R"({"found":false,"error":"a \"b\"\nc"})");
}

}  // namespace
}  // namespace gannet::tool

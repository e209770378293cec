#include "src/daemon/control_commands.hpp"

#include <gtest/gtest.h>

namespace gannet::daemon {
namespace {

using control::Answer;
using control::ErrorCode;
using control::Failure;
using control::Json;
using safety::Request;

class ControlCommandsTest : public testing::Test {
 protected:
  ControlCommandsTest() {
    loaded_.config.vehicle.kind = "rov";
    ServoReport& servo = report_lines_.servo.back();
    servo.loop.cycles = 1;
    servo.supervisor.state = safety::State::kStandby;
    report_lines_.servo.publish();
    make();
  }
  void make() {
    ControlCommands::Setting setting;
    setting.loaded = &loaded_;
    setting.models = {"crab", "dolphin"};
    setting.image_width = 640;
    setting.image_height = 480;
    setting.now = [] { return time_from_ns(2'000'000'000); };
    setting.pause = pause_;
    sut_.emplace(std::move(setting), &reports_, &lines_);
  }
  Answer ask(const std::string& method, const Json& params = Json::object()) {
    return sut_->handle({1, method, params});
  }
  Json result(const std::string& method, const Json& params = Json::object()) {
    const Answer answer = ask(method, params);
    EXPECT_TRUE(std::holds_alternative<Json>(answer))
        << (answer.index() == 1 ? std::get<Failure>(answer).text : "");
    return answer.index() == 0 ? std::get<Json>(answer) : Json();
  }
  Failure failure(const std::string& method, const Json& params = Json::object()) {
    const Answer answer = ask(method, params);
    EXPECT_TRUE(std::holds_alternative<Failure>(answer)) << method << params;
    return answer.index() == 1 ? std::get<Failure>(answer) : Failure{};
  }

  config::LoadedConfig loaded_;
  ReportLines report_lines_;
  CommandLines lines_;
  Reports reports_{&report_lines_};
  std::function<void()> pause_;
  std::optional<ControlCommands> sut_;
};

TEST_F(ControlCommandsTest, an_unknown_method_or_param_is_told_with_the_nearest) {
  const Failure method = failure("staus");
  EXPECT_EQ(method.code, ErrorCode::kUnknownMethod);
  EXPECT_NE(method.text.find("\"status\""), std::string::npos);
  const Failure param = failure("target", {{"modle", "crab"}});
  EXPECT_EQ(param.code, ErrorCode::kBadParams);
  EXPECT_NE(param.text.find("\"model\""), std::string::npos);
}

TEST_F(ControlCommandsTest, status_says_all_that_an_estimate_carries) {
  PoseEstimate& e = report_lines_.vision.back().estimate;
  e.found = true;
  e.target_id = 3;
  e.model = 1;
  e.state = TrackState::kLocked;
  e.reason = TrackReason::kNone;
  e.frame_number = 12;
  e.capture_time = time_from_ns(1'960'000'000);
  e.left_from_target.translation = {0.1, -0.2, 0.7};
  e.covariance.diagonal().setConstant(4e-6);
  report_lines_.vision.publish();
  const Json estimate = result("status")["estimate"];
  EXPECT_EQ(estimate["target_id"], 3);
  EXPECT_EQ(estimate["model"], "dolphin");
  EXPECT_EQ(estimate["state"], "locked");
  EXPECT_EQ(estimate["reason"], "none");
  EXPECT_NEAR(estimate["age_s"].get<double>(), 0.04, 1e-9);
  EXPECT_EQ(estimate["position_m"], Json({0.1, -0.2, 0.7}));
  EXPECT_EQ(estimate["quaternion"], Json({1.0, 0.0, 0.0, 0.0}));
  ASSERT_EQ(estimate["covariance"].size(), 36u);
  EXPECT_EQ(estimate["covariance"][7], 4e-6);
  EXPECT_EQ(estimate["covariance_order"].size(), 6u);
  EXPECT_NE(estimate["frame"].get<std::string>().find("left camera"), std::string::npos);
}

TEST_F(ControlCommandsTest, without_a_pose_its_fields_are_null) {
  const Json status = result("status");
  EXPECT_TRUE(status["estimate"]["position_m"].is_null());
  EXPECT_TRUE(status["estimate"]["age_s"].is_null());
  EXPECT_EQ(status["state"], "standby");
  EXPECT_FALSE(status["target"]["valid"].get<bool>());
}

TEST_F(ControlCommandsTest, an_emergency_stop_that_is_not_there_is_not_called_inactive) {
  const auto told = [this](bool has_estop, safety::Line line) {
    ServoReport& servo = report_lines_.servo.back();
    servo.has_estop = has_estop;
    servo.estop = line;
    report_lines_.servo.publish();
    return result("status")["estop"].get<std::string>();
  };
  EXPECT_EQ(told(true, safety::Line::kUnknown), "unknown");
  EXPECT_EQ(told(true, safety::Line::kInactive), "inactive");
  EXPECT_EQ(told(true, safety::Line::kActive), "active");
  EXPECT_EQ(told(false, safety::Line::kInactive), "no line");
}

TEST_F(ControlCommandsTest, requests_go_to_the_servo_loop) {
  const std::pair<const char*, Request> requests[] = {{"arm", Request::kArm},
                                                      {"disarm", Request::kDisarm},
                                                      {"reset", Request::kReset},
                                                      {"stop", Request::kStop}};
  for (const auto& [name, request] : requests) {
    EXPECT_FALSE(result(name)["served"].get<bool>());  // stepped: at the next step
    ServoCommand command;
    ASSERT_TRUE(lines_.to_servo.pop(command));
    EXPECT_EQ(command.request, request);
  }
}

TEST_F(ControlCommandsTest, arming_is_refused_with_its_obstacle) {
  report_lines_.servo.back().loop.cycles = 1;
  report_lines_.servo.back().outputs.obstacle = safety::Cause::kDrivesSilent;
  report_lines_.servo.publish();
  const Failure refused = failure("arm");
  EXPECT_EQ(refused.code, ErrorCode::kRefused);
  EXPECT_EQ(refused.reason, "drives_silent");
  ServoCommand command;
  EXPECT_FALSE(lines_.to_servo.pop(command));
}

TEST_F(ControlCommandsTest, live_a_request_waits_for_its_cycle_and_tells_its_refusal) {
  pause_ = [this] {
    ServoCommand command;
    if (!lines_.to_servo.pop(command)) return;
    ServoReport& servo = report_lines_.servo.back();
    servo.served = command.number;
    servo.refused = safety::Cause::kEstop;
    report_lines_.servo.publish();
  };
  make();
  EXPECT_EQ(failure("reset").reason, "estop");
}

TEST_F(ControlCommandsTest, a_target_is_a_model_by_name_a_rectangle_or_none) {
  EXPECT_EQ(result("target", {{"model", "dolphin"}})["id"], 1);
  EXPECT_EQ(result("target", {{"roi", {10, 20, 630, 460}}})["id"], 2);
  EXPECT_EQ(result("target", {{"none", true}})["id"], 0);
  TargetChoice choice;
  ASSERT_TRUE(lines_.to_vision.pop(choice));
  EXPECT_EQ(choice.model, 1);
  ASSERT_TRUE(lines_.to_vision.pop(choice));
  EXPECT_EQ(choice.kind, TargetChoice::Kind::kRectangle);
  EXPECT_EQ(choice.rectangle.height, 460);
  ASSERT_TRUE(lines_.to_vision.pop(choice));
  EXPECT_EQ(choice.kind, TargetChoice::Kind::kNone);
}

TEST_F(ControlCommandsTest, bad_targets_change_nothing) {
  result("target", {{"model", "crab"}});
  TargetChoice choice;
  lines_.to_vision.pop(choice);
  const Json bad[] = {Json::object(),
                      {{"model", "crub"}},
                      {{"model", 3}},
                      {{"roi", {10, 20, 631, 460}}},
                      {{"roi", {-1, 20, 30, 40}}},
                      {{"roi", {0, 0, 7, 8}}},
                      {{"roi", {0, 0, 8.5, 8}}},
                      {{"roi", {1, 2, 3}}},
                      {{"roi", {1, 2, 3, "x"}}},
                      {{"roi", {1e18, 0, 10, 10}}},
                      {{"none", false}},
                      {{"none", true}, {"model", "crab"}}};
  for (const Json& params : bad) {
    EXPECT_EQ(failure("target", params).code, ErrorCode::kBadParams) << params;
  }
  EXPECT_FALSE(lines_.to_vision.pop(choice));
  EXPECT_EQ(result("status")["chosen"]["model"], "crab");
}

TEST_F(ControlCommandsTest, a_goal_goes_to_the_servo_loop_in_metres) {
  EXPECT_EQ(result("goal", {{"mm", {10, -20, 500}}})["goal_mm"], Json({10.0, -20.0, 500.0}));
  const servo::ServoParams& params = lines_.params.read();
  EXPECT_EQ(params.goal_x_m, 0.01);
  EXPECT_EQ(params.goal_y_m, -0.02);
  EXPECT_EQ(params.goal_z_m, 0.5);
  const Json bad[] = {Json::object(),         {{"mm", {0, 0}}},      {{"mm", {0, 0, "far"}}},
                      {{"mm", {0, 0, -500}}}, {{"mm", {0, 0, 1e9}}}, {{"mm", 500}}};
  for (const Json& params_of_bad : bad) {
    EXPECT_EQ(failure("goal", params_of_bad).code, ErrorCode::kBadParams) << params_of_bad;
  }
  EXPECT_FALSE(lines_.params.fresh());
}

TEST_F(ControlCommandsTest, the_hand_needs_a_vehicle_and_whole_vectors) {
  const Json good = {{"linear_m_s", {0.2, 0, 0}}, {"angular_rad_s", {0, 0, 0.1}}};
  EXPECT_GT(result("manual", good)["timeout_s"].get<double>(), 0);
  ServoCommand command;
  ASSERT_TRUE(lines_.to_servo.pop(command));
  EXPECT_TRUE(command.by_hand);
  EXPECT_EQ(command.velocity.angular.z(), 0.1);
  EXPECT_EQ(command.time, time_from_ns(2'000'000'000));  // of its arrival
  EXPECT_EQ(failure("manual", {{"linear_m_s", {0.2, 0, 0}}}).code, ErrorCode::kBadParams);
  EXPECT_EQ(failure("manual", {{"linear_m_s", {9, 0, 0}}, {"angular_rad_s", {0, 0, 0}}}).code,
            ErrorCode::kBadParams);
  loaded_.config.vehicle.kind = "none";
  EXPECT_EQ(failure("manual", good).reason, "no_vehicle");
}

TEST_F(ControlCommandsTest, events_are_told_from_a_number_on) {
  for (int i = 1; i <= 3; ++i) result("goal", {{"mm", {i, 0, 500}}});
  const Json events = result("events", {{"since", 1}});
  ASSERT_EQ(events["events"].size(), 2u);
  EXPECT_EQ(events["events"][0]["number"], 2);
  EXPECT_EQ(events["events"][0]["name"], "goal_set");
  EXPECT_EQ(events["last"], 3);
  EXPECT_EQ(failure("events", {{"since", "x"}}).code, ErrorCode::kBadParams);
  EXPECT_EQ(failure("events", {{"since", -1}}).code, ErrorCode::kBadParams);
}

TEST_F(ControlCommandsTest, config_show_has_every_value_with_its_origin) {
  bool found = false;
  const Json shown = result("config_show");
  for (const Json& value : shown["values"]) {
    found |= value["key"] == "servo.position_gain" && value["origin"] == "built-in";
  }
  EXPECT_TRUE(found) << shown["values"].size();
}

TEST_F(ControlCommandsTest, top_has_stages_latencies_and_drops) {
  const Json top = result("top");
  ASSERT_EQ(top["loops"].size(), 3u);
  EXPECT_EQ(top["loops"][2]["name"], "servo");
  EXPECT_EQ(top["loops"][2]["stages"].size(), 9u);
  EXPECT_TRUE(top["latencies"].contains("frame_to_can"));
  EXPECT_TRUE(top["drops"].contains("servo_overruns"));
}

TEST_F(ControlCommandsTest, a_full_line_is_told_as_busy) {
  for (int i = 0; i < 16; ++i) result("stop");
  EXPECT_EQ(failure("stop").code, ErrorCode::kBusy);
}

}  // namespace
}  // namespace gannet::daemon

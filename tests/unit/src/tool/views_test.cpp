#include "src/tool/views.hpp"

#include <gtest/gtest.h>

namespace gannet::tool {
namespace {

using control::Json;

TEST(Views, status_tells_state_target_and_error) {
  const Json status = Json::parse(R"({
    "state": "servoing", "cause": "none", "permit": "full", "by_hand": false, "estop": "inactive",
    "obstacle": "none", "version": "1.2", "vehicle": "rov", "camera": "simulated", "clock": "live",
    "chosen": {"kind": "model", "model": "crab"}, "goal_mm": [0, 0, 500],
    "estimate": {"state": "locked", "reason": "none", "fitness": 0.876, "age_s": 0.0412},
    "target": {"valid": true, "position_hand_mm": [1.26, -2, 503], "sigma_hand_mm": [1, 1, 2],
               "rpy_hand_deg": [0, 0, 3.14], "error_mm": [1, 2, 3], "error_deg": [0, 0, 3]},
    "drives": {"all_alive": true, "any_fault": false, "bus": "good"}})");
  const std::string text = status_text(status);
  for (const char* part :
       {"state     servoing, permit full\n", "target    model crab\n",
        "goal      0, 0, 500 mm in the hand frame\n", "locked, fitness 0.876, age 41 ms",
        "1.3, -2.0, 503.0 mm in the hand frame", "drives    all alive, bus good",
        "gannetd 1.2, vehicle rov"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Views, status_tells_what_is_wrong_with_which_drive) {
  const Json status = Json::parse(R"({"drives": {
    "all_alive": true, "any_fault": true, "all_ready": true, "guards_itself": true, "bus": "good",
    "first_bad": 2, "trouble": "heartbeat lost", "trouble_code": 33072}})");
  EXPECT_NE(status_text(status).find(
                "all alive, one in fault, motor 3: heartbeat lost (0x8130), bus good"),
            std::string::npos)
      << status_text(status);
  const Json refused = Json::parse(R"({"drives": {
    "all_alive": true, "any_fault": false, "all_ready": false, "guards_itself": false,
    "bus": "good", "first_bad": 0, "trouble": "", "trouble_code": 0}})");
  EXPECT_NE(status_text(refused).find("all alive, not all set up, one would not stop by itself"),
            std::string::npos)
      << status_text(refused);
}

TEST(Views, what_a_daemon_does_not_say_is_a_dash) {
  for (const Json& nothing : {Json(), Json::object(), Json::array({1, 2}), Json("text")}) {
    EXPECT_NE(status_text(nothing).find("state     –"), std::string::npos);
    EXPECT_NE(top_text(nothing).find("–"), std::string::npos);
    EXPECT_NE(event_text(nothing).find("–"), std::string::npos);
  }
  const Json odd = Json::parse(R"({"loops": [3, {"stages": {"a": 1}}], "latencies": {"x": 3},
                                   "ages_ms": {"vision": null}})");
  EXPECT_NE(top_text(odd).find("vision –"), std::string::npos) << top_text(odd);
}

TEST(Views, top_shows_each_stage_with_its_budget) {
  const Json top = Json::parse(R"({
    "state": "standby", "permit": "none", "track": "locked", "fitness": 0.9,
    "loops": [{"name": "servo", "cycles": 5, "stages": [
      {"name": "receive", "last_us": 12.34, "mean_us": 11, "max_us": 99, "p99_us": 50,
       "budget_us": 500, "over_budget": 2}]}],
    "latencies": {"frame_to_pose": {"p50_us": 12000, "p90_us": 15000, "p99_us": 20000,
                                    "p99_9_us": 21000, "max_us": 30000}},
    "ages_ms": {"estimate": 40.2}, "drops": {"camera_dropped": 3},
    "cameras": {"frozen": 2, "short": 0, "skew_ms": -1.25}})");
  const std::string text = top_text(top);
  for (const char* part :
       {"receive", "12.3", "500", "frame_to_pose", "12.00", "30.00", "estimate 40.2",
        "camera_dropped 3", "cameras  frozen 2.0, skew_ms -1.2"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Views, an_event_is_one_line) {
  EXPECT_EQ(event_text(Json::parse(
                R"({"time_ns": 1500000000, "severity": "warning", "text": "camera silent"})")),
            "1.500  warning  camera silent");
}

}  // namespace
}  // namespace gannet::tool

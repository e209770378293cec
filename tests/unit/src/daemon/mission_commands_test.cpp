#include <gtest/gtest.h>

#include "src/daemon/control_commands.hpp"

namespace gannet::daemon {
namespace {

using control::Answer;
using control::Failure;
using control::Json;
using std::chrono::milliseconds;
using std::chrono::seconds;

// The loops are played: what they would report is written by hand.
class MissionCommandsTest : public testing::Test {
 protected:
  MissionCommandsTest() {
    loaded_.config.vehicle.kind = "rov";
    servo::VisitConfig crab, starfish;
    crab.model = "crab";
    crab.goal_x_m = -0.08;
    crab.hold_s = 1;
    starfish = crab;
    starfish.model = "starfish";
    starfish.time_out_s = 5;
    loaded_.config.mission.visits = {crab, starfish};
    make();
    armed();
  }
  void make() {
    ControlCommands::Setting setting;
    setting.loaded = &loaded_;
    setting.models = {"starfish", "crab"};
    setting.image_width = 640;
    setting.image_height = 480;
    setting.now = [this] { return now_; };
    sut_.emplace(std::move(setting), &reports_, &lines_);
  }
  void armed(safety::State state = safety::State::kServoing) {
    report_.supervisor.state = state;
    report_.outputs.permit = Permit::kFull;
    report_.loop.cycles = 1;
    publish();
  }
  void publish() {
    report_.loop.time = now_;
    report_.target.target_id = vision_.estimate.target_id;
    report_lines_.servo.write(report_);
    report_lines_.vision.write(vision_);
  }
  // What the vision loop is asked for goes on; at its goal, as the loops say.
  void take_choices() {
    while (lines_.to_vision.pop(choice_)) ++choices_;
    vision_.estimate.target_id = choice_.id;
    vision_.estimate.state =
        choice_.kind == TargetChoice::Kind::kNone ? TrackState::kSearching : TrackState::kLocked;
    report_.target.valid = choice_.kind != TargetChoice::Kind::kNone;
  }
  void run(Duration length) {
    for (const TimePoint end = now_ + length; now_ < end;) {
      now_ += milliseconds(50);
      take_choices();
      publish();
      sut_->advance();
    }
    take_choices();
  }
  Answer ask(const std::string& method, const Json& params = Json::object()) {
    return sut_->handle({1, method, params});
  }
  std::string refusal(const std::string& word) {
    const Answer answer = ask("mission", {{"do", word}});
    return answer.index() == 1 ? std::get<Failure>(answer).reason : "";
  }
  Json mission(const std::string& word = "status") {
    const Answer answer = ask("mission", {{"do", word}});
    return answer.index() == 0 ? std::get<Json>(answer) : Json();
  }

  config::LoadedConfig loaded_;
  ReportLines report_lines_;
  CommandLines lines_;
  Reports reports_{&report_lines_};
  TimePoint now_ = time_from_ns(2'000'000'000);
  ServoReport report_;
  VisionReport vision_;
  TargetChoice choice_;
  int choices_ = 0;
  std::optional<ControlCommands> sut_;
};

TEST_F(MissionCommandsTest, lists_the_config) {
  const Json list = mission("list");
  ASSERT_EQ(list["visits"].size(), 2u);
  EXPECT_EQ(list["visits"][1]["model"], "starfish");
  EXPECT_EQ(list["visits"][0]["goal_mm"][0], -80.0);
}

TEST_F(MissionCommandsTest, refuses_with_a_reason) {
  for (const auto state : {safety::State::kStandby, safety::State::kStopped,
                           safety::State::kFaulted, safety::State::kStarting}) {
    armed(state);
    EXPECT_EQ(refusal("start"), "not_armed");
  }
  armed();
  EXPECT_EQ(ask("mission", {{"do", "begin"}}).index(), 1u);
  EXPECT_EQ(ask("mission").index(), 1u);
  EXPECT_EQ(mission("start")["state"], "running");
  EXPECT_EQ(refusal("start"), "under_way");
  loaded_.config.mission.visits.clear();
  make();
  EXPECT_EQ(refusal("start"), "no_mission");
  take_choices();
  EXPECT_EQ(choices_, 1);
}

TEST_F(MissionCommandsTest, a_report_that_is_old_counts_as_not_armed) {
  now_ += seconds(1);
  EXPECT_EQ(refusal("start"), "not_armed");
}

TEST_F(MissionCommandsTest, makes_its_visits_in_turn_and_never_asks_the_servo_loop_for_anything) {
  mission("start");
  run(milliseconds(100));
  EXPECT_EQ(choice_.model, 1);
  EXPECT_EQ(lines_.params.read().goal_x_m, -0.08);
  run(milliseconds(1000));
  EXPECT_EQ(choice_.model, 0);
  EXPECT_EQ(mission()["visit"], 2);
  run(milliseconds(1100));
  EXPECT_EQ(mission()["state"], "done");
  EXPECT_EQ(choice_.model, 0);  // held on
  ServoCommand command;
  EXPECT_FALSE(lines_.to_servo.pop(command));
  const auto status = std::get<Json>(ask("status"));
  EXPECT_EQ(status["mission"]["state"], "done");
  int events = 0;
  const Json told = std::get<Json>(ask("events"));
  for (const Json& event : told["events"]) events += event["name"] == "mission_changed";
  EXPECT_EQ(events, 3);
}

TEST_F(MissionCommandsTest, another_target_s_estimate_is_not_the_visit_s) {
  mission("start");
  for (int i = 0; i < 100; ++i) {
    now_ += milliseconds(50);
    if (lines_.to_vision.pop(choice_)) ++choices_;
    vision_.estimate.target_id = choice_.id + 1;
    vision_.estimate.state = TrackState::kLocked;
    report_.target.valid = true;
    publish();
    sut_->advance();
  }
  EXPECT_EQ(mission()["visit"], 1);
}

TEST_F(MissionCommandsTest, a_time_out_drops_the_target_until_a_person_starts_it_again) {
  mission("start");
  run(milliseconds(1150));
  ASSERT_EQ(mission()["visit"], 2);
  report_.error.position_m.x() = 1;
  run(seconds(6));
  EXPECT_EQ(mission()["state"], "timed_out");
  EXPECT_EQ(choice_.kind, TargetChoice::Kind::kNone);
  report_.error.position_m.x() = 0;
  run(seconds(6));
  EXPECT_EQ(choice_.kind, TargetChoice::Kind::kNone);
  EXPECT_EQ(mission("start")["visit"], 2);
  run(milliseconds(1200));
  EXPECT_EQ(mission()["state"], "done");
}

TEST_F(MissionCommandsTest, a_stop_and_an_end_of_arming_drop_the_target) {
  mission("start");
  run(milliseconds(100));
  EXPECT_EQ(mission("stop")["state"], "stopped");
  take_choices();
  EXPECT_EQ(choice_.kind, TargetChoice::Kind::kNone);
  mission("start");
  run(milliseconds(100));
  ASSERT_EQ(choice_.kind, TargetChoice::Kind::kModel);
  armed(safety::State::kStandby);
  run(milliseconds(100));
  EXPECT_EQ(mission()["state"], "stopped");
  EXPECT_EQ(choice_.kind, TargetChoice::Kind::kNone);
  armed();
  run(seconds(5));
  EXPECT_EQ(mission()["state"], "stopped");
}

TEST_F(MissionCommandsTest, a_servo_loop_that_fell_silent_ends_it) {
  mission("start");
  run(milliseconds(100));
  now_ += seconds(1);
  sut_->advance();
  EXPECT_EQ(mission()["state"], "stopped");
}

TEST_F(MissionCommandsTest, a_lost_target_pauses_it) {
  mission("start");
  run(milliseconds(500));
  vision_.estimate.state = TrackState::kLost;
  now_ += milliseconds(50);
  publish();
  sut_->advance();
  EXPECT_EQ(mission()["state"], "paused");
  EXPECT_EQ(mission()["visit"], 1);
}

TEST_F(MissionCommandsTest, somebody_else_s_target_or_goal_ends_it_and_stays) {
  mission("start");
  run(milliseconds(100));
  ask("goal", {{"mm", {10, 0, 500}}});
  EXPECT_EQ(mission()["state"], "stopped");
  run(milliseconds(100));
  EXPECT_EQ(choice_.kind, TargetChoice::Kind::kModel);
  EXPECT_EQ(lines_.params.read().goal_x_m, 0.01);
  mission("start");
  run(milliseconds(100));
  ask("target", {{"model", "starfish"}});
  EXPECT_EQ(mission()["state"], "stopped");
  run(seconds(5));
  EXPECT_EQ(choice_.model, 0);
}

TEST_F(MissionCommandsTest, without_room_for_a_choice_it_ends_and_drops_the_target_later) {
  while (lines_.to_vision.push({})) continue;
  EXPECT_EQ(mission("start")["state"], "stopped");
  TargetChoice choice;
  while (lines_.to_vision.pop(choice)) continue;
  sut_->advance();
  ASSERT_TRUE(lines_.to_vision.pop(choice));
  EXPECT_EQ(choice.kind, TargetChoice::Kind::kNone);
  sut_->advance();
  EXPECT_FALSE(lines_.to_vision.pop(choice));
}

}  // namespace
}  // namespace gannet::daemon

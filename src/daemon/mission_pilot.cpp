#include "src/daemon/mission_pilot.hpp"

#include <algorithm>

namespace gannet::daemon {
namespace {

using control::Json;
using servo::MissionState;

// The control thread turns at least every 0.1 s; a servo cycle takes 0.1 s at most.
constexpr Duration kOldest = std::chrono::milliseconds(500);

servo::MissionFacts facts_of(const VisionReport& vision, const ServoReport& servo,
                             std::uint32_t chosen, TimePoint now) {
  servo::MissionFacts facts;
  facts.armed = is_armed(servo, now);
  facts.following = servo.outputs.permit == Permit::kFull && !servo.outputs.by_hand;
  // A short coast is no loss: the supervisor says how old an estimate may be followed.
  const TrackState track = vision.estimate.state;
  facts.target_sure = chosen != 0 && vision.estimate.target_id == chosen &&
                      (track == TrackState::kLocked || track == TrackState::kCoasting) &&
                      servo.target.valid && servo.target.target_id == chosen &&
                      servo.target.age <= kOldest;
  facts.error_m = servo.error.position_m.norm();
  return facts;
}

}  // namespace

bool is_armed(const ServoReport& servo, TimePoint now) {
  const safety::State state = servo.supervisor.state;
  const bool armed = state == safety::State::kArmed || state == safety::State::kServoing ||
                     state == safety::State::kHolding;
  return armed && now - servo.loop.time <= kOldest;
}

MissionPilot::MissionPilot(const servo::MissionConfig& config,
                           const std::vector<std::string>& models)
    : config_(config) {
  for (const servo::VisitConfig& visit : config_.visits)
    models_.push_back(
        static_cast<int>(std::find(models.begin(), models.end(), visit.model) - models.begin()));
}

int MissionPilot::visits() const {
  return config_.rounds * static_cast<int>(config_.visits.size());
}

const servo::VisitConfig& MissionPilot::visit() const {
  return config_.visits[static_cast<std::size_t>(memory_.visit) % config_.visits.size()];
}

MissionPilot::Turn MissionPilot::start(const ServoReport& servo, TimePoint now) {
  const servo::MissionMemory before = memory_;
  memory_ = servo::start_mission(before, visits(), is_armed(servo, now), now);
  return turn_from(before);
}

MissionPilot::Turn MissionPilot::stop(bool leave) {
  const servo::MissionMemory before = memory_;
  memory_ = servo::stop_mission(before);
  Turn turn = turn_from(before);
  turn.drops = turn.drops && !leave;
  return turn;
}

MissionPilot::Turn MissionPilot::step(const VisionReport& vision, const ServoReport& servo,
                                      std::uint32_t chosen, TimePoint now) {
  if (!under_way()) return {};
  const servo::MissionMemory before = memory_;
  memory_ = servo::step(before, visits(), servo::limits_of(visit()),
                        facts_of(vision, servo, chosen, now), now);
  return turn_from(before);
}

MissionPilot::Turn MissionPilot::turn_from(const servo::MissionMemory& before) {
  Turn turn;
  turn.changed = memory_.state != before.state || memory_.visit != before.visit;
  const bool runs = memory_.state == MissionState::kRunning;
  turn.begins = runs && memory_.visit_since != before.visit_since;
  const bool gave_up =
      memory_.state == MissionState::kTimedOut || memory_.state == MissionState::kStopped;
  turn.drops = turn.changed && gave_up;
  if (!turn.begins) return turn;
  const servo::VisitConfig& due = visit();
  turn.model = models_[static_cast<std::size_t>(memory_.visit) % models_.size()];
  turn.goal_m = {due.goal_x_m, due.goal_y_m, due.goal_z_m};
  return turn;
}

Json MissionPilot::status_json() const {
  Json json;
  json["state"] = servo::to_string(memory_.state);
  json["visits"] = visits();
  const bool has_visit = memory_.state != MissionState::kIdle;
  json["visit"] = has_visit ? Json(memory_.visit + 1) : Json();
  json["model"] = has_visit ? Json(visit().model) : Json();
  json["arrived"] = memory_.arrived;
  json["there"] = memory_.there;
  return json;
}

Json MissionPilot::list_json() const {
  Json list = Json::array();
  constexpr double kMillimetres = 1e3;
  for (const servo::VisitConfig& v : config_.visits)
    list.push_back(
        {{"model", v.model},
         {"goal_mm",
          {v.goal_x_m * kMillimetres, v.goal_y_m * kMillimetres, v.goal_z_m * kMillimetres}},
         {"tolerance_mm", v.tolerance_m * kMillimetres},
         {"hold_s", v.hold_s},
         {"time_out_s", v.time_out_s}});
  return {{"rounds", config_.rounds}, {"visits", list}};
}

}  // namespace gannet::daemon

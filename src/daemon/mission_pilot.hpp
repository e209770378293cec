// MissionPilot: the config's mission and how far it has come. Of the loops' newest reports it makes
// the facts of a mission's step, and says what a person would otherwise type: which target and
// goal, or none. It moves nothing itself: what is followed is the supervisor's affair.
// Control thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "src/control/json.hpp"
#include "src/daemon/messages.hpp"
#include "src/servo/mission_config.hpp"

namespace gannet::daemon {

class MissionPilot {
 public:
  // What a step asks for.
  struct Turn {
    bool changed = false;                              // state or visit: an event
    bool begins = false;                               // a visit: choose model and goal
    bool drops = false;                                // choose no target
    int model = -1;                                    // index
    Eigen::Vector3d goal_m = Eigen::Vector3d::Zero();  // Σ_H
  };

  // models: their names by index. Every visit's is one of them.
  MissionPilot(const servo::MissionConfig& config, const std::vector<std::string>& models);

  bool under_way() const { return servo::is_under_way(memory_.state); }
  const servo::MissionMemory& memory() const { return memory_; }
  int visits() const;  // in all rounds

  // Nothing happens without visits, while one runs, or not armed.
  Turn start(const ServoReport& servo, TimePoint now);
  // leave: the target is another's choice from now on and is not dropped.
  Turn stop(bool leave);
  // chosen: the target's id that the visit was given.
  Turn step(const VisionReport& vision, const ServoReport& servo, std::uint32_t chosen,
            TimePoint now);

  control::Json status_json() const;
  control::Json list_json() const;

 private:
  const servo::VisitConfig& visit() const;
  Turn turn_from(const servo::MissionMemory& before);

  const servo::MissionConfig config_;
  std::vector<int> models_;  // of the visits
  servo::MissionMemory memory_;
};

// Armed by a person, as a report says that is not too old.
bool is_armed(const ServoReport& servo, TimePoint now);

}  // namespace gannet::daemon

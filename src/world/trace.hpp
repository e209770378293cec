// Trace: what happened, a row a servo period: the truth, what the daemon said, what it commanded.
// Rows go to CSV; checks and the result are computed from them. World's thread alone.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "platform/base/result.hpp"
#include "src/core/transform.hpp"

namespace gannet::world {

inline constexpr int kMaxMotors = 12;

// What the daemon last said of its target.
struct HeardEstimate {
  std::uint64_t frame = 0;  // 0: nothing yet
  double capture_s = 0;
  bool found = false;
  std::string state;       // of the track
  std::string supervisor;  // its state
  std::string permit;
  Transform<LeftCamera, Target> left_from_target;
  double fitness = 0;
  // Of a mission; empty model: none is under way.
  std::string visit_model;
  Eigen::Vector3d visit_goal_m = Eigen::Vector3d::Zero();
  bool arrived = false;  // was there in this visit
  int visits_done = 0;
};

struct TraceRow {
  double time_s = 0;
  Transform<World, Body> vehicle;
  Transform<Hand, Target> target;                     // the truth, of the chosen target
  Transform<LeftCamera, Target> at_capture;           // the truth when the heard frame was taken
  bool in_view = false;                               // the whole of it, in both images
  Eigen::Vector3d error_m = Eigen::Vector3d::Zero();  // target − goal in Σ_H
  double error_rad = 0;                               // of the controlled turn: about Σ_H's y
  std::array<double, kMaxMotors> throttle = {};       // as the drives obey them
  bool armed = false;                                 // as the bus says
  bool estop = false;
  bool release = false;
  HeardEstimate heard;
};

struct Mark {
  double time_s = 0;
  std::string text;
};

// From then on the drives are still (disarmed, none told to turn) or not, by the time of the frame
// on the bus that told them, or of the drives' own decision.
struct TurnMark {
  double time_s = 0;
  bool still = false;
};

struct Trace {
  int motors = 0;
  double period_s = 0.005;
  Transform<Hand, World> reference_from_world;  // the hand at the vehicle's reference place
  Transform<Body, Hand> body_from_hand;
  std::vector<TraceRow> rows;
  std::vector<Mark> marks;                 // events as they happened
  std::vector<TurnMark> turns;             // in order of time
  std::map<std::string, double> counters;  // the daemon's own, at the end

  // Time of the first mark with this text; negative: none.
  double time_of(const std::string& text) const;
};

std::string trace_csv(const Trace& trace);
std::string events_csv(const Trace& trace);

}  // namespace gannet::world

// ReportRun: what `gannet-world --record` left of one run, read for a report: result.json,
// trace.csv, events.csv, rig.toml, models and kept frames. Positions here are in Σ_H as it stood at
// the vehicle's reference place (x right, y down, z forward), mm and degrees for people. Normal
// thread.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "hal/camera/frame_directory.hpp"
#include "platform/base/result.hpp"
#include "src/control/json.hpp"
#include "src/core/stereo_rig.hpp"

namespace gannet::tool {

using Axes3 = std::array<std::vector<double>, 3>;  // x, y, z over time

// What the daemon said of one frame, beside the truth at its exposure.
struct ReportFrame {
  double capture_s = 0;
  bool found = false;
  double fitness = 0;
  Transform<LeftCamera, Target> estimate;
  Transform<LeftCamera, Target> truth;
};

struct ReportEvent {
  double time_s = 0;
  std::string text;
};

struct ReportRun {
  std::string folder;
  control::Json result;
  bool stepped = false;
  StereoRig rig;

  std::vector<double> time_s;
  Axes3 error_mm;               // target − goal in Σ_H
  std::vector<double> yaw_deg;  // the controlled turn
  Axes3 target_mm;              // the target's path
  Axes3 held_mm;                // the path of the place before the hand where it should be
  std::vector<std::vector<double>> throttle;  // of each drive, −1 … 1
  std::vector<ReportFrame> frames;            // in order, each once
  std::vector<ReportEvent> events;
  std::vector<hal::FramePair> pictures;  // kept pairs; may be empty

  std::string scenario() const;
  bool passed() const;       // the scenario's checks
  double arm_s() const;      // 0: it never was
  double settled_s() const;  // scenario's time from which the error stays small; NaN: never
};

// Error: which file is missing or wrong.
Result<ReportRun> read_run(const std::string& folder);

// The number under a path of keys ("latencies/servo_jitter/p99_us"); NaN: there is none.
double number_at(const control::Json& json, std::string_view path);
const control::Json* member_at(const control::Json& json, std::string_view path);  // null: none

}  // namespace gannet::tool

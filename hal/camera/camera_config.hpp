// What the config says of cameras: one struct a kind, and which kind it is. Values; start-up only.
#pragma once

#include <string>

#include "platform/base/describe.hpp"

namespace gannet::hal {

struct ReplayCameraConfig {
  std::string directory;
  double rate_hz = 30;  // where there is no times.csv
  bool loop = false;
  int slots = 8;
};

struct SimulatedCameraConfig {
  std::string name = "gannet-frames";
  double connect_timeout_s = 10;
  double silence_s = 0.5;
};

struct CameraConfig {
  std::string kind = "simulated";
  ReplayCameraConfig replay;
  SimulatedCameraConfig simulated;
};

void describe(Visitor& v, ReplayCameraConfig& c);
void describe(Visitor& v, SimulatedCameraConfig& c);
void describe(Visitor& v, CameraConfig& c);

}  // namespace gannet::hal

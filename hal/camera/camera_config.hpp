// What the config says of cameras: one struct a kind, and which kind it is. Values; start-up only.
#pragma once

#include <string>
#include <vector>

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

// What both V4L2 kinds say of their device or devices.
struct V4l2StreamConfig {
  int width = 640;  // pixels of the device's image
  int height = 480;
  std::string format = "yuyv";
  double rate_hz = 30;  // 0: as the driver has it
  std::vector<std::string> controls = {};
  int buffers = 8;
  bool accept_unknown_clock = false;
  double exposure_s = 0;
  double readout_s = 0;
  double connect_timeout_s = 10;
  double silence_s = 0.5;
  double decode_limit_s = 0.05;
  int decoded_slots = 8;
};

struct V4l2PairConfig {
  std::string left;
  std::string right;
  double pair_tolerance_s = 0.005;
  V4l2StreamConfig stream;
};

struct V4l2SideBySideConfig {
  std::string device;
  bool right_first = false;
  V4l2StreamConfig stream = {.width = 1280};
};

struct CameraConfig {
  std::string kind = "simulated";
  ReplayCameraConfig replay;
  SimulatedCameraConfig simulated;
  V4l2PairConfig v4l2_pair;
  V4l2SideBySideConfig v4l2_side_by_side;
};

void describe(Visitor& v, ReplayCameraConfig& c);
void describe(Visitor& v, SimulatedCameraConfig& c);
void describe(Visitor& v, V4l2PairConfig& c);
void describe(Visitor& v, V4l2SideBySideConfig& c);
void describe(Visitor& v, CameraConfig& c);

}  // namespace gannet::hal

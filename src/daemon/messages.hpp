// What the daemon's loops say to each other: small values that go through rings, and the reports
// that go to the control thread. Each carries its time. RT safe.
#pragma once

#include <atomic>
#include <cstdint>

#include "hal/camera/stereo_camera.hpp"
#include "hal/can/can_bus.hpp"
#include "hal/drive/drive.hpp"
#include "platform/base/latest_value.hpp"
#include "platform/base/ring.hpp"
#include "src/core/motion.hpp"
#include "src/core/pose_estimate.hpp"
#include "src/core/predicted_pose.hpp"
#include "src/safety/supervisor.hpp"
#include "src/servo/servo_law.hpp"
#include "src/telemetry/loop_telemetry.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::daemon {

// capture → vision → archive. taken: when we had it, by CLOCK_MONOTONIC also in stepped time.
struct TakenFrame {
  hal::StereoFrame frame;
  TimePoint taken = {};
};

// vision → servo.
struct SeenTarget {
  PoseEstimate estimate;
  TimePoint taken = {};  // of its frame
};

// control → vision.
struct TargetChoice {
  enum class Kind : std::uint8_t { kNone, kModel, kRectangle };
  Kind kind = Kind::kNone;
  int model = -1;
  vision::Rectangle rectangle;
  std::uint32_t id = 0;
};

// control → servo. A request, or a velocity commanded by hand.
struct ServoCommand {
  safety::Request request = safety::Request::kNone;
  bool by_hand = false;
  Twist<Body> velocity;
  TimePoint time = {};       // by hand: when it arrived at the control thread, by the loops' clock
  std::uint64_t number = 0;  // running; the report says the newest one that was served
};

// Told without order to whoever asks: single words.
struct SharedFacts {
  std::atomic<std::int64_t> last_frame_ns{0};  // loop's time of the newest pair; 0: none yet
  std::atomic<std::uint64_t> capture_cycles{0};
  std::atomic<std::uint64_t> vision_cycles{0};
  std::atomic<std::uint64_t> servo_cycles{0};
  std::atomic<bool> stop{false};
};

struct CaptureReport {
  telemetry::LoopTelemetry<2> loop;
  hal::CaptureStatus status = hal::CaptureStatus::kNothing;
  hal::CaptureCounters camera;
  std::uint64_t not_taken = 0;  // vision had no room
};

struct VisionReport {
  telemetry::LoopTelemetry<5> loop;
  PoseEstimate estimate;
  std::uint64_t frames = 0;
  std::uint64_t skipped = 0;         // older pairs given back unseen
  std::uint64_t preempted = 0;       // searches that a newer pair ended
  std::uint64_t estimates_lost = 0;  // servo had no room
  std::uint64_t not_archived = 0;    // archive had no room
  LogHistogram frame_to_pose;
};

struct ServoReport {
  telemetry::LoopTelemetry<9> loop;
  safety::Memory supervisor;
  safety::Outputs outputs;
  bool has_estop = true;  // false: no line is configured, and estop says nothing
  safety::Line estop = safety::Line::kUnknown;
  std::uint64_t estop_presses = 0;
  std::uint64_t estop_discrepancies = 0;
  bool by_hand_active = false;
  PredictedPose target;
  servo::ServoError error;
  double reach_scale = 1;
  hal::DriveGroupHealth drives;
  hal::BusState bus = hal::BusState::kDown;
  hal::CanCounters can;
  std::uint64_t drives_malformed = 0;
  std::uint64_t filter_rejected = 0;
  std::uint64_t overruns = 0;
  std::uint64_t served = 0;                      // number of the newest command
  safety::Cause refused = safety::Cause::kNone;  // of that command
  LogHistogram jitter;
  LogHistogram frame_to_can;     // frame taken → motors told
  LogHistogram exposure_to_can;  // middle of exposure → motors told, by the loop's clock
};

}  // namespace gannet::daemon

// ServoLoop: the eight steps of a servo cycle, at a fixed rate:
//   1 receive CAN, GPIO  2 read targets  3 predict to now  4 supervisor.step
//   5 law → vehicle  6 permit gate (one line)  7 send CAN, GPIO  8 record
// Knows no thread: the same body runs live and stepped. Servo thread; RT safe.
#pragma once

#include <vector>

#include "hal/can/can_bus.hpp"
#include "hal/drive/drive.hpp"
#include "hal/gpio/digital_line.hpp"
#include "platform/base/event.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/daemon/messages.hpp"
#include "src/safety/estop_input.hpp"
#include "src/safety/watchdogs.hpp"
#include "src/track/pose_filter.hpp"
#include "src/vehicle/vehicle.hpp"

namespace gannet::daemon {

class ServoLoop {
 public:
  // A null device is one that the config does not have.
  struct Links {
    vehicle::Vehicle* vehicle;
    servo::ServoLaw* law;
    hal::CanBus* bus;
    hal::DriveGroup* drives;
    hal::DigitalInput* estop;
    hal::DigitalOutput* light;
    SpscRing<SeenTarget>* targets;
    SpscRing<ServoCommand>* commands;
    LatestValue<servo::ServoParams>* params;
    LatestValue<ServoReport>* report;
    EventPort* events;
    SharedFacts* facts;
    hal::DigitalInput* estop_second = nullptr;  // null: the e-stop has one channel
  };

  ServoLoop(const Links& links, const StereoRig& rig, const safety::SafetyConfig& safety,
            const track::FilterConfig& filter, const servo::ServoParams& params, Duration period);

  // missed: periods skipped before this cycle; late: woken after its time.
  void step(TimePoint now, std::int64_t missed = 0, Duration late = {});

  // Commands every motor to stop; for the end of the program.
  void shut_down(TimePoint now);

 private:
  enum Stage { kReceive, kTargets, kPredict, kSupervise, kLaw, kGate, kSend, kRecord, kCycle };
  void receive(TimePoint now);
  void read_estop(TimePoint now);
  void receive_commands(TimePoint now);
  void read_targets(TimePoint now);
  void supervise(TimePoint now, std::int64_t missed);
  safety::Inputs inputs_at(TimePoint now);
  bool is_over_limits() const;
  void steer(TimePoint now);
  void note_own_motion(TimePoint now);
  void send(bool enable, TimePoint now);
  void write_light(TimePoint now);
  void record(TimePoint now, Duration late);
  void tell_changes(const safety::Memory& before, TimePoint now);
  void tell_devices(TimePoint now);
  bool setpoints_are_finite() const;

  Links links_;
  const safety::SafetyConfig safety_;
  const Duration period_;
  // Camera in the body, for the camera's own motion; identity without body_from_hand.
  const Transform<Body, LeftCamera> body_from_left_;
  track::PoseFilter filter_;
  safety::OverrunWatch overrun_watch_;
  safety::AgeWatch bus_watch_;
  safety::LimitWatch limit_watch_;
  safety::EstopInput estop_input_;

  servo::Goal goal_;
  ServoReport report_;
  TrackState track_state_ = TrackState::kSearching;
  safety::Request request_ = safety::Request::kNone;
  Twist<Body> hand_;
  TimePoint hand_time_ = {};
  TimePoint last_ = {};
  bool internal_fault_ = false;
  std::int64_t untold_overruns_ = 0;
  TimePoint overruns_told_ = {};
  std::uint32_t target_id_ = 0;  // chosen, as vision says
  SeenTarget newest_;            // found, and not yet acted on
  bool newest_is_new_ = false;
  std::vector<hal::DriveSetpoint> setpoints_;
  std::vector<hal::CanFrame> out_;
  std::vector<hal::ReceivedCanFrame> in_;
};

}  // namespace gannet::daemon

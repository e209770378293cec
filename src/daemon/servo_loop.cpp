#include "src/daemon/servo_loop.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/linux/clock.hpp"
#include "src/telemetry/event_codes.hpp"

#include "platform/base/rt_only.hpp"

namespace gannet::daemon {

using linux_os::monotonic_now;
using safety::Cause;
using telemetry::make_event;

namespace {

Transform<Body, LeftCamera> camera_in_body(const StereoRig& rig) {
  return rig.body_from_hand ? *rig.body_from_hand * rig.hand_from_left
                            : Transform<Body, LeftCamera>{};
}

// A rigid body's velocity as the camera on it has it.
Twist<LeftCamera> seen_by_camera(const Twist<Body>& body,
                                 const Transform<Body, LeftCamera>& body_from_left) {
  const Eigen::Quaterniond left_from_body = body_from_left.rotation.conjugate();
  return {left_from_body * (body.linear + body.angular.cross(body_from_left.translation)),
          left_from_body * body.angular};
}

double largest_sigma(const Matrix12d& covariance) {
  const Eigen::Matrix3d position = covariance.topLeftCorner<3, 3>();
  // Not a number: as uncertain as can be.
  if (!position.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(position, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()(2)));
}

safety::EstopInput::Channel channel_of(const hal::DigitalInput::Reading& reading) {
  using safety::Line;
  const Line line = reading.level == hal::Level::kUnknown ? Line::kUnknown
                    : reading.level == hal::Level::kHigh  ? Line::kActive
                                                          : Line::kInactive;
  return {line, reading.rose, reading.fell};
}

}  // namespace

ServoLoop::ServoLoop(const Links& links, const StereoRig& rig, const safety::SafetyConfig& safety,
                     const track::FilterConfig& filter, const servo::ServoParams& params,
                     Duration period)
    : links_(links),
      safety_(safety),
      period_(period),
      body_from_left_(camera_in_body(rig)),
      filter_(filter),
      overrun_watch_(safety.overrun_limit, from_seconds(safety.overrun_window_s)),
      bus_watch_(from_seconds(safety.bus_age_s)),
      limit_watch_(from_seconds(safety.motor_limit_s)),
      estop_input_(safety),
      goal_(servo::goal_of(params)),
      setpoints_(static_cast<std::size_t>(links.vehicle->motors())),
      out_(links.drives == nullptr ? 0 : static_cast<std::size_t>(links.drives->max_frames())),
      in_(64) {
  const char* names[] = {"receive", "targets", "predict", "supervise", "law",
                         "gate",    "send",    "record",  "cycle"};
  for (int i = 0; i <= kCycle; ++i) {
    report_.loop.timer.name(i, names[i], i == kCycle ? period : Duration{});
  }
}

void ServoLoop::step(TimePoint now, std::int64_t missed, Duration late) {
  auto& timer = report_.loop.timer;
  const TimePoint begin = monotonic_now();
  timer.begin(begin);
  receive(now);
  timer.lap(kReceive, monotonic_now());
  read_targets(now);
  timer.lap(kTargets, monotonic_now());
  report_.target = filter_.predict(now);
  timer.lap(kPredict, monotonic_now());
  supervise(now, missed);
  timer.lap(kSupervise, monotonic_now());
  steer(now);
  timer.lap(kLaw, monotonic_now());
  // The permit gate: nothing moves a motor but through this line.
  const bool enable = report_.outputs.permit != Permit::kNone && report_.outputs.drive_enable &&
                      setpoints_are_finite();
  timer.lap(kGate, monotonic_now());
  send(enable, now);
  timer.lap(kSend, monotonic_now());
  record(now, late);
  const TimePoint end = monotonic_now();
  timer.lap(kRecord, end);
  timer.add(kCycle, end - begin);
}

void ServoLoop::shut_down(TimePoint now) {
  for (auto& setpoint : setpoints_) setpoint.value = 0;
  report_.outputs = {};  // the light goes out
  send(false, now);
}

void ServoLoop::receive(TimePoint now) {
  receive_commands(now);
  if (links_.bus != nullptr) {
    int n = 0;
    int rounds = 0;  // bounded: a flooded bus must not hold the loop
    do {
      n = links_.bus->receive(in_, now);
      for (int i = 0; i < n; ++i) {
        const auto& received = in_[static_cast<std::size_t>(i)];
        links_.drives->receive(received.frame, received.time);
      }
      if (n > 0) bus_watch_.feed(now);
    } while (n == static_cast<int>(in_.size()) && ++rounds < 8);
  }
  read_estop(now);
}

void ServoLoop::read_estop(TimePoint now) {
  report_.has_estop = links_.estop != nullptr;
  report_.estop = safety::Line::kInactive;
  if (!report_.has_estop) return;
  const safety::EstopInput::Channel first = channel_of(links_.estop->read(now));
  report_.estop = links_.estop_second == nullptr
                      ? estop_input_.step(first, now)
                      : estop_input_.step(first, channel_of(links_.estop_second->read(now)), now);
  report_.estop_presses = estop_input_.presses();
  if (report_.estop_discrepancies == estop_input_.discrepancies()) return;
  report_.estop_discrepancies = estop_input_.discrepancies();
  links_.events->raise(make_event(telemetry::kEstopDiscrepancy, now));
}

// One request a cycle, so that none hides another; hand commands: the newest counts.
void ServoLoop::receive_commands(TimePoint now) {
  request_ = safety::Request::kNone;
  ServoCommand command;
  while (request_ == safety::Request::kNone && links_.commands->pop(command)) {
    report_.served = command.number;
    request_ = command.request;
    if (!command.by_hand) continue;
    hand_ = command.velocity;
    hand_time_ = std::min(command.time, now);  // it may have come during this cycle
    report_.by_hand_active = true;
  }
  if (request_ == safety::Request::kDisarm || request_ == safety::Request::kStop) {
    report_.by_hand_active = false;
  }
  const Duration time_out = from_seconds(safety_.manual_age_s);
  if (now - hand_time_ > time_out) report_.by_hand_active = false;
  if (links_.params->fresh()) {
    const servo::ServoParams& params = links_.params->read();
    links_.law->set(params);
    goal_ = servo::goal_of(params);
  }
}

void ServoLoop::read_targets(TimePoint now) {
  SeenTarget seen;
  while (links_.targets->pop(seen)) {
    track_state_ = seen.estimate.state;
    const bool is_other = seen.estimate.target_id != target_id_;
    target_id_ = seen.estimate.target_id;
    if (is_other || seen.estimate.reason == TrackReason::kNoTarget) filter_.clear();
    const track::FilterResult result = filter_.update(seen.estimate, now);
    if (result == track::FilterResult::kReset || result == track::FilterResult::kStarted) {
      links_.events->raise(make_event(telemetry::kFilterReset, now, seen.estimate.target_id));
    }
    if (seen.estimate.found) {
      newest_ = seen;
      newest_is_new_ = true;
    }
  }
}

void ServoLoop::supervise(TimePoint now, std::int64_t missed) {
  overrun_watch_.note(static_cast<int>(missed), now);
  if (missed > 0) {
    report_.overruns += static_cast<std::uint64_t>(missed);
    untold_overruns_ += missed;
  }
  // At most once a second: an overloaded machine must not also be flooded with words.
  if (untold_overruns_ > 0 && now - overruns_told_ >= std::chrono::seconds(1)) {
    links_.events->raise(make_event(telemetry::kOverrun, now, static_cast<double>(untold_overruns_),
                                    static_cast<double>(report_.overruns)));
    untold_overruns_ = 0;
    overruns_told_ = now;
  }
  const safety::Memory before = report_.supervisor;
  const safety::Decision decision = safety::step(safety_, before, inputs_at(now), now);
  report_.supervisor = decision.memory;
  report_.outputs = decision.outputs;
  if (request_ != safety::Request::kNone) report_.refused = decision.outputs.refused;
  const bool is_reset =
      request_ == safety::Request::kReset && decision.outputs.refused == Cause::kNone;
  if (is_reset && links_.drives != nullptr) links_.drives->reset_faults(now);
  tell_changes(before, now);
}

safety::Inputs ServoLoop::inputs_at(TimePoint now) {
  safety::Inputs inputs;
  const SharedFacts& facts = *links_.facts;
  inputs.started = facts.capture_cycles.load(std::memory_order_relaxed) > 0 &&
                   facts.vision_cycles.load(std::memory_order_relaxed) > 0;
  inputs.estop = report_.estop;
  inputs.has_estop = links_.estop != nullptr;
  inputs.request = request_;
  inputs.has_vehicle = links_.vehicle->motors() > 0;
  inputs.internal_fault = internal_fault_;
  tell_devices(now);
  inputs.drive_fault = report_.drives.any_fault;
  inputs.drives_alive = report_.drives.all_alive;
  inputs.drives_ready = report_.drives.all_ready;
  inputs.drives_guarded = report_.drives.guards_itself;
  inputs.bus_ok =
      links_.bus == nullptr || (report_.bus != hal::BusState::kDown &&
                                report_.bus != hal::BusState::kOff && bus_watch_.fresh(now));
  inputs.limits_exceeded = limit_watch_.exceeded(is_over_limits(), now);
  inputs.overruns = overrun_watch_.exceeded(now);
  const std::int64_t last_frame = facts.last_frame_ns.load(std::memory_order_relaxed);
  inputs.camera_alive =
      last_frame != 0 && now - time_from_ns(last_frame) <= from_seconds(safety_.camera_age_s);
  inputs.manual_active = report_.by_hand_active;
  inputs.manual_age = now - hand_time_;
  inputs.track = track_state_;
  inputs.estimate_valid = report_.target.valid;
  inputs.estimate_age = report_.target.age;
  inputs.estimate_sigma_m = largest_sigma(report_.target.covariance);
  return inputs;
}

// What a drive does not tell is 0 and exceeds nothing.
bool ServoLoop::is_over_limits() const {
  if (links_.drives == nullptr) return false;
  constexpr double kZeroCelsius_k = 273.15;
  const double hottest_k = safety_.motor_temperature_c + kZeroCelsius_k;
  const auto felt = links_.drives->feedback();
  return std::any_of(felt.begin(), felt.end(), [&](const hal::DriveFeedback& motor) {
    return (safety_.motor_temperature_c > 0 && motor.temperature_k > hottest_k) ||
           (safety_.motor_current_a > 0 && std::abs(motor.current_a) > safety_.motor_current_a);
  });
}

void ServoLoop::steer(TimePoint now) {
  const Duration dt = last_ == TimePoint{} ? period_ : now - last_;
  last_ = now;
  const Permit permit = report_.outputs.permit;
  // While a hand steers the law must not wind up for the moment when it lets go.
  const Permit for_law = report_.outputs.by_hand ? Permit::kHoldOnly : permit;
  MotionWish wish = links_.law->update(report_.target, goal_, for_law, dt);
  report_.error = links_.law->error();
  if (report_.outputs.by_hand) {
    wish = {};
    wish.velocity = hand_;
  }
  if (links_.drives != nullptr) links_.vehicle->sense(links_.drives->feedback(), now);
  const vehicle::Reach reach = links_.vehicle->update(wish, permit, dt, setpoints_);
  report_.reach_scale = reach.scale;
  note_own_motion(now);
  const bool is_finite = wish.velocity.linear.allFinite() && wish.velocity.angular.allFinite();
  if ((!is_finite || !setpoints_are_finite()) && !internal_fault_) {
    internal_fault_ = true;
    links_.events->raise(make_event(telemetry::kInternalFault, now, kLaw));
  }
}

// What the vehicle does by command must not look like the target's motion. Without a vehicle
// nobody knows it, and the filter's velocities are relative to the camera.
void ServoLoop::note_own_motion(TimePoint now) {
  if (links_.vehicle->motors() == 0) return;
  filter_.note_own_motion(now, seen_by_camera(links_.vehicle->own_velocity(), body_from_left_));
}

bool ServoLoop::setpoints_are_finite() const {
  return std::all_of(setpoints_.begin(), setpoints_.end(),
                     [](const hal::DriveSetpoint& s) { return std::isfinite(s.value); });
}

void ServoLoop::send(bool enable, TimePoint now) {
  write_light(now);
  if (links_.bus == nullptr) return;
  const int n = links_.drives->send(setpoints_, enable, now, out_);
  const std::span<const hal::CanFrame> frames(out_.data(), static_cast<std::size_t>(n));
  const int sent = n > 0 ? links_.bus->send(frames, now) : 0;
  if (sent > 0) bus_watch_.feed(now);
  if (!newest_is_new_ || sent == 0) return;
  newest_is_new_ = false;
  report_.frame_to_can.add(monotonic_now() - newest_.taken);
  report_.exposure_to_can.add(now - newest_.estimate.capture_time);
}

void ServoLoop::write_light(TimePoint now) {
  if (links_.light == nullptr) return;
  const std::int64_t half_seconds = to_ns(now) / 500'000'000;
  const std::int64_t tenths = to_ns(now) / 100'000'000;
  bool on = false;
  switch (report_.outputs.light) {
    case safety::Light::kOff:
      break;
    case safety::Light::kOn:
      on = true;
      break;
    case safety::Light::kSlow:
      on = half_seconds % 2 == 0;
      break;
    case safety::Light::kFast:
      on = tenths % 2 == 0;
      break;
  }
  links_.light->write(on, now);
}

void ServoLoop::record(TimePoint now, Duration late) {
  report_.jitter.add(late);
  report_.filter_rejected = filter_.counters().rejected;
  if (links_.bus != nullptr) {
    report_.can = links_.bus->counters();
    report_.drives_malformed = links_.drives->malformed();
  }
  report_.loop.cycles += 1;
  report_.loop.time = now;
  links_.report->write(report_);
  links_.facts->servo_cycles.store(report_.loop.cycles, std::memory_order_relaxed);
}

void ServoLoop::tell_changes(const safety::Memory& before, TimePoint now) {
  const safety::Memory& after = report_.supervisor;
  if (before.state != after.state) {
    links_.events->raise(
        make_event(telemetry::kStateChanged, now, static_cast<double>(before.state),
                   static_cast<double>(after.state), static_cast<double>(after.cause)));
  }
  if (report_.outputs.refused != Cause::kNone) {
    links_.events->raise(
        make_event(telemetry::kRequestRefused, now, static_cast<double>(report_.outputs.refused)));
  }
  // The integral parts of a vehicle that stood still belong to another situation.
  if (before.state == safety::State::kStandby && after.state != before.state) {
    links_.vehicle->reset();
  }
}

void ServoLoop::tell_devices(TimePoint now) {
  if (links_.bus == nullptr) {
    report_.drives = {.all_alive = true};
    return;
  }
  const hal::BusState bus = links_.bus->state();
  if (bus != report_.bus) {
    Event event = make_event(telemetry::kBusChanged, now, static_cast<double>(bus));
    if (bus == hal::BusState::kGood) event.severity = Severity::kNotice;
    links_.events->raise(event);
  }
  report_.bus = bus;
  const hal::DriveGroupHealth before = report_.drives;
  report_.drives = links_.drives->health(now);
  const hal::DriveGroupHealth& after = report_.drives;
  const int motor = after.first_bad + 1;  // people count from 1, as the config's errors do
  if (!after.all_ready && after.trouble_code != 0 && before.trouble_code != after.trouble_code) {
    links_.events->raise(make_event(telemetry::kDriveRefused, now, motor, after.trouble_code));
  }
  if (before.all_alive == after.all_alive && before.any_fault == after.any_fault) return;
  const EventCode code = after.any_fault   ? telemetry::kDriveFault
                         : after.all_alive ? telemetry::kDrivesGood
                                           : telemetry::kDriveSilent;
  links_.events->raise(make_event(code, now, motor, after.trouble_code));
}

}  // namespace gannet::daemon

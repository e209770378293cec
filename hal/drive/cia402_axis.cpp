#include "hal/drive/cia402_axis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gannet::hal::cia402 {

using canopen::NmtCommand;
using canopen::NmtState;
using canopen::SdoStatus;
using Kind = SetupStep::Kind;
using Fact = SetupStep::Fact;

namespace {

constexpr Duration kRetry = std::chrono::seconds(1);            // after a refusal
constexpr Duration kAskAgain = std::chrono::milliseconds(500);  // after silence
constexpr Duration kStepTime = std::chrono::milliseconds(500);  // kExpectSoon
constexpr Duration kStartTime = std::chrono::seconds(1);        // NMT start to operational
constexpr Duration kStartAgain = std::chrono::milliseconds(150);
constexpr Duration kEnableTime = std::chrono::seconds(1);  // enable to operation enabled
constexpr Duration kResetTime = std::chrono::seconds(5);   // a person's reset is valid so long
constexpr Duration kPulseTime = std::chrono::milliseconds(200);  // of the fault reset bit
constexpr Duration kHeardTime = std::chrono::seconds(3);         // while it is not yet set up
constexpr ObjectId kErrorCode = {0x603F, 0};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
}  // namespace

Cia402Axis::Cia402Axis(const AxisSettings& settings, const Cia402Config& config)
    : settings_(settings),
      config_(config),
      steps_(setup_steps(config, settings.node, settings.own_node)),
      sdo_(settings.node, from_seconds(config.sdo_timeout_s)) {
  feedback_.current_a = feedback_.voltage_v = feedback_.temperature_k = kNan;
}

// ---- in -----------------------------------------------------------------------------------------

bool Cia402Axis::hear_heartbeat(const CanFrame& frame, TimePoint time) {
  const auto state = canopen::heartbeat_from(frame);
  if (!state) return false;
  heard_ = heartbeat_ = time;
  was_heard_ = true;
  if (*state == NmtState::kBootUp) {
    trip_if_enabled(Trip::kRestarted);
    emergency_ = {};
    begin_setup(time);
  } else if (*state == NmtState::kOperational) {
    if (phase_ == AxisPhase::kStarting) enter(AxisPhase::kRunning, time);
  } else if (phase_ == AxisPhase::kRunning) {
    trip_if_enabled(Trip::kNotOperational);
    begin_setup(time);
  }
  if (phase_ == AxisPhase::kAbsent) begin_setup(time);
  return true;
}

bool Cia402Axis::hear_emergency(const CanFrame& frame, TimePoint time) {
  const auto emergency = canopen::emergency_from(frame);
  if (!emergency) return false;
  heard_ = time;
  was_heard_ = true;
  emergency_ = *emergency;
  if (emergency->code != 0) ++feedback_.error_count;
  return true;
}

bool Cia402Axis::hear_answer(const CanFrame& frame, TimePoint time) {
  heard_ = time;
  was_heard_ = true;
  return sdo_.receive(frame);
}

bool Cia402Axis::hear_pdo(const CanFrame& frame, TimePoint time) {
  if (phase_ != AxisPhase::kRunning) return true;  // mapped otherwise as yet, or for somebody else
  if (frame.length < tpdo_bytes(config_)) return false;
  const std::span<const std::uint8_t> data = frame.data;
  heard_ = feedback_.time = time;
  was_heard_ = has_status_ = true;
  const State before = state_;
  state_ = state_of(static_cast<std::uint16_t>(canopen::get(data.first(2))));
  feedback_.speed_rad_s =
      static_cast<std::int32_t>(canopen::get(data.subspan(2, 4))) / settings_.units_per_rad_s;
  if (config_.report_current && rated_current_a_ > 0) {
    const auto per_mille = static_cast<std::int16_t>(canopen::get(data.subspan(6, 2)));
    feedback_.current_a = per_mille * rated_current_a_ / 1000;
  }
  // Both come with each SYNC; one that stays away must not leave an old position for a new one.
  if (++since_position_ > 2) feedback_.position_rad = kNan;
  if (state_ == State::kFault && before != State::kFault) asks_for_code_ = emergency_.code == 0;
  if (state_ != State::kFault && state_ != State::kFaultReaction) asks_for_code_ = false;
  return true;
}

bool Cia402Axis::hear_position(const CanFrame& frame) {
  if (phase_ != AxisPhase::kRunning) return true;
  if (frame.length < kPositionBytes) return false;
  const std::span<const std::uint8_t> data = frame.data;
  feedback_.position_rad = static_cast<std::int32_t>(canopen::get(data.first(kPositionBytes))) /
                           settings_.increments_per_rad;
  since_position_ = 0;
  return true;
}

// ---- set-up -------------------------------------------------------------------------------------

void Cia402Axis::enter(AxisPhase phase, TimePoint now) {
  phase_ = phase;
  phase_since_ = now;
  if (phase == AxisPhase::kRunning) return;
  has_status_ = false;
  feedback_.position_rad = kNan;
  state_ = State::kUnknown;
  asks_for_code_ = false;
}

void Cia402Axis::begin_setup(TimePoint now) {
  enter(AxisPhase::kSettingUp, now);
  nmt_ = NmtCommand::kPreOperational;
  watches_us_ = reacts_ = watches_setpoints_ = false;
  rated_current_a_ = 0;
  step_ = 0;
  sdo_.cancel();
  step_since_.reset();
}

void Cia402Axis::next_step(TimePoint now) {
  while (step_ < steps_.size() && steps_[step_].only_unguarded && guards_itself()) ++step_;
  if (step_ == steps_.size()) {
    refusal_ = {};
    sdo_.cancel();
    nmt_ = NmtCommand::kStart;
    enter(AxisPhase::kStarting, now);
    return;
  }
  const SetupStep& step = steps_[step_];
  const bool is_write = step.kind == Kind::kWrite || step.kind == Kind::kOffer;
  if (is_write) {
    sdo_.write(step.object, step.value, step.bytes);
  } else {
    sdo_.read(step.object);
  }
  if (!step_since_) step_since_ = now;
}

void Cia402Axis::judge_step(TimePoint now) {
  const SetupStep& step = steps_[step_];
  const SdoStatus status = sdo_.status();
  const bool is_done = status == SdoStatus::kDone;
  if (status == SdoStatus::kTimedOut) {
    trip_if_enabled(Trip::kLost);
    enter(AxisPhase::kAbsent, now);
    return;
  }
  // A shorter object than wanted reads as zero-extended; compare what is there.
  const bool matches = is_done && (sdo_.value() & step.mask) == (step.value & step.mask);
  if (step.kind == Kind::kWrite && !is_done) return refuse(step, now);
  if (step.kind == Kind::kExpect && !matches) return refuse(step, now);
  if (step.kind == Kind::kExpectSoon && !matches) {
    if (!is_done || now - *step_since_ >= kStepTime) return refuse(step, now);
    return next_step(now);
  }
  if (step.kind == Kind::kLearn) {
    learn(step, is_done ? std::optional(sdo_.value()) : std::nullopt);
  }
  ++step_;
  step_since_.reset();
  next_step(now);
}

void Cia402Axis::learn(const SetupStep& step, std::optional<std::uint32_t> value) {
  if (step.fact == Fact::kConsumer) watches_us_ = value == step.value;
  if (step.fact == Fact::kRpdoTimer) watches_setpoints_ = value == step.value;
  if (step.fact == Fact::kReaction) reacts_ = value && *value >= 1 && *value <= 3;
  if (step.fact == Fact::kRatedCurrent) rated_current_a_ = value.value_or(0) / 1000.0;
}

void Cia402Axis::refuse(const SetupStep& step, TimePoint now) {
  refusal_ = {step.object, sdo_.abort_code(), sdo_.value()};
  enter(AxisPhase::kRefused, now);
}

// ---- out ----------------------------------------------------------------------------------------

int Cia402Axis::manage(TimePoint now, std::span<CanFrame> out) {
  if (!has_begun_) {
    has_begun_ = true;
    begin_setup(now);
  }
  watch(now);
  if (phase_ == AxisPhase::kSettingUp) {
    if (sdo_.status() == SdoStatus::kIdle)
      next_step(now);
    else if (sdo_.status() != SdoStatus::kWaiting)
      judge_step(now);
  }
  if (phase_ == AxisPhase::kRunning) ask_for_code();
  std::size_t n = 0;
  if (nmt_) out[n++] = canopen::nmt_frame(*nmt_, settings_.node);
  if (nmt_ == NmtCommand::kStart) start_sent_ = now;
  nmt_.reset();
  if (const auto request = sdo_.poll(now)) out[n++] = *request;
  set_state(now);
  return static_cast<int>(n);
}

void Cia402Axis::watch(TimePoint now) {
  const Duration in_phase = now - phase_since_;
  switch (phase_) {
    case AxisPhase::kAbsent:
      if (in_phase >= kAskAgain) begin_setup(now);
      break;
    case AxisPhase::kRefused:
      if (in_phase >= kRetry) begin_setup(now);
      break;
    case AxisPhase::kStarting:  // the command, or what told of its effect, may have been lost
      if (in_phase >= kStartTime) {
        begin_setup(now);
      } else if (now - start_sent_ >= kStartAgain) {
        nmt_ = NmtCommand::kStart;
      }
      break;
    case AxisPhase::kRunning:
      if (now - std::max(heartbeat_, phase_since_) > from_seconds(config_.node_timeout_s)) {
        trip_if_enabled(Trip::kLost);
        enter(AxisPhase::kAbsent, now);
      }
      break;
    case AxisPhase::kSettingUp:
      break;
  }
}

// A drive in fault whose EMCY nobody heard is asked for its code.
void Cia402Axis::ask_for_code() {
  if (sdo_.status() == SdoStatus::kDone && asks_for_code_) {
    emergency_.code = static_cast<std::uint16_t>(sdo_.value());
    asks_for_code_ = false;
    sdo_.cancel();
  } else if (asks_for_code_ && sdo_.status() == SdoStatus::kIdle) {
    sdo_.read(kErrorCode);
  } else if (sdo_.status() != SdoStatus::kWaiting) {
    asks_for_code_ = false;
    sdo_.cancel();
  }
}

std::optional<CanFrame> Cia402Axis::command(std::optional<double> setpoint, bool enable,
                                            TimePoint now) {
  const Goal wanted = goal(setpoint.has_value(), enable, now);
  if (phase_ != AxisPhase::kRunning) return {};
  const std::uint16_t word = next_control_word(state_, wanted);
  double target = 0;
  if (wanted == Goal::kRun && state_ == State::kOperationEnabled) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    target = std::clamp(std::round(*setpoint * settings_.full_units), -kMost, kMost);
  }
  CanFrame frame = {
      .id = canopen::rpdo_base(config_.pdo) + static_cast<std::uint32_t>(settings_.node),
      .length = kRpdoBytes};
  canopen::put(std::span(frame.data).first(2), word);
  canopen::put(std::span(frame.data).subspan(2, 4),
               static_cast<std::uint32_t>(static_cast<std::int32_t>(target)));
  return frame;
}

Goal Cia402Axis::goal(bool has_setpoint, bool enable, TimePoint now) {
  if (enable && !is_enabled_) {
    enabled_since_ = now;
    has_run_ = false;
  }
  is_enabled_ = enable;
  if (!enable) trip_ = Trip::kNone;
  if (enable) {
    if (phase_ != AxisPhase::kRunning) trip_if_enabled(Trip::kNotOperational);
    const bool runs = state_ == State::kOperationEnabled;
    if (is_faulty()) {
      trip_if_enabled(Trip::kFault);
    } else if (has_run_ && !runs) {
      trip_if_enabled(Trip::kLeftOperation);
    } else if (!has_run_ && now - enabled_since_ > kEnableTime) {
      trip_if_enabled(Trip::kDidNotEnable);
    }
    has_run_ = has_run_ || runs;
    if (trip_ == Trip::kNone && is_ready(now)) {
      stop_since_.reset();
      return has_setpoint ? Goal::kRun : Goal::kHalt;
    }
  }
  if (!stop_since_) stop_since_ = now;
  if (const auto reset = reset_goal(now)) return *reset;
  const bool ramps =
      config_.stop == "quick_stop" && now - *stop_since_ < from_seconds(config_.stop_time_s);
  return ramps ? Goal::kStop : Goal::kOff;
}

void Cia402Axis::reset_fault(TimePoint now) {
  reset_since_ = now;
  pulse_since_.reset();
  has_reset_communication_ = false;
}

std::optional<Goal> Cia402Axis::reset_goal(TimePoint now) {
  if (reset_since_ && now - *reset_since_ > kResetTime) reset_since_.reset();
  if (!reset_since_ || is_enabled_ || phase_ != AxisPhase::kRunning || !has_status_) return {};
  if (state_ != State::kFault) {
    if (state_ != State::kFaultReaction) reset_since_.reset();
    return {};
  }
  // Some drives leave a communication fault only after their communication has been reset.
  const bool is_of_communication = (emergency_.code & 0xFF00) == 0x8100;
  if (is_of_communication && !has_reset_communication_) {
    has_reset_communication_ = true;
    enter(AxisPhase::kAbsent, now);  // its boot-up follows
    nmt_ = NmtCommand::kResetCommunication;
    return {};
  }
  if (!pulse_since_) pulse_since_ = now;
  if (now - *pulse_since_ > kPulseTime) {
    reset_since_.reset();
    return {};
  }
  return Goal::kReset;
}

// ---- health -------------------------------------------------------------------------------------

void Cia402Axis::trip_if_enabled(Trip why) {
  if (is_enabled_ && trip_ == Trip::kNone) trip_ = why;
}

bool Cia402Axis::is_alive(TimePoint now) const {
  if (phase_ != AxisPhase::kRunning) {
    return was_heard_ && phase_ != AxisPhase::kAbsent && now - heard_ <= kHeardTime;
  }
  return now - std::max(feedback_.time, phase_since_) <= settings_.feedback_timeout;
}

bool Cia402Axis::is_ready(TimePoint now) const {
  return phase_ == AxisPhase::kRunning && has_status_ && is_alive(now);
}

bool Cia402Axis::is_faulty() const {
  return trip_ != Trip::kNone || state_ == State::kFault || state_ == State::kFaultReaction;
}

std::uint16_t Cia402Axis::fault_code() const {
  if (!is_faulty()) return 0;
  const bool is_ours = trip_ != Trip::kNone && trip_ != Trip::kFault;
  if (!is_ours && emergency_.code != 0) return emergency_.code;
  return static_cast<std::uint16_t>(is_ours ? trip_ : Trip::kFault);
}

void Cia402Axis::set_state(TimePoint now) {
  feedback_.fault_code = fault_code();
  feedback_.state = is_faulty()                          ? DriveState::kFault
                    : !is_ready(now)                     ? DriveState::kUnknown
                    : state_ == State::kOperationEnabled ? DriveState::kEnabled
                                                         : DriveState::kDisabled;
}

}  // namespace gannet::hal::cia402

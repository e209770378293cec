// Cia402Node: one CiA 402 velocity drive on CANopen, as an honest slave: object dictionary behind
// an SDO server, NMT, heartbeat both ways, PDOs as they are mapped, EMCY, the drive's state
// machine, ramps, quick stop and fault reaction, and what it does when its master falls silent.
// Frames and transitions are written here from the standards' tables (CiA 301, CiA 402-2), apart
// from the master's in hal/drive; only the list of objects is shared. World's thread alone.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "hal/can/can_frame.hpp"
#include "hal/drive/cia402_objects.hpp"
#include "platform/base/time.hpp"

namespace gannet::world {

class Cia402Node {
 public:
  enum class Power : std::uint8_t {  // the drive's states, by their names in the standard
    kNotReadyToSwitchOn,
    kSwitchOnDisabled,
    kReadyToSwitchOn,
    kSwitchedOn,
    kOperationEnabled,
    kQuickStopActive,
    kFaultReactionActive,
    kFault,
  };

  explicit Cia402Node(int id);

  // A drive that lacks an object, or has it fixed. Sub −1: all of the index.
  void lack(std::uint16_t index, int sub = -1);
  void fix(std::uint16_t index);

  void power_on(TimePoint now);  // boots, again if need be; what was set is forgotten
  void hear(const hal::CanFrame& frame, TimePoint now);
  // What passes by itself: timers, ramps, automatic transitions.
  void step(TimePoint now);
  // Frames said since the last call.
  std::vector<hal::CanFrame> take_said() { return std::exchange(said_, {}); }

  // What the plant makes of it, in the drive's own units: 606C, and mA, mV; 6064.
  void measure(double velocity, double current_ma, double voltage_mv, double position = 0);
  // A fault that lasts until it is 0 again: a fault reset succeeds only then.
  void set_fault(std::uint16_t code) { fault_ = code; }

  double demand() const { return demand_; }  // velocity after ramps; 0 when the power is off
  Power power() const { return power_; }
  std::uint8_t nmt() const { return nmt_; }  // as its heartbeat says
  int id() const { return id_; }
  std::uint64_t guard_events() const { return guard_events_; }

 private:
  using Key = std::pair<std::uint16_t, std::uint8_t>;
  struct Object {
    hal::cia402::ObjectAbout about;
    std::uint32_t value = 0;
  };
  struct Abort {
    std::uint32_t code = 0;  // 0: none
  };

  void set_defaults(bool only_communication);
  std::uint32_t get(std::uint16_t index, std::uint8_t sub = 0) const;
  std::int32_t get_signed(std::uint16_t index) const;
  void set(std::uint16_t index, std::uint8_t sub, std::uint32_t value);
  void say(std::uint32_t id, std::initializer_list<std::uint8_t> bytes);

  void hear_nmt(const hal::CanFrame& frame, TimePoint now);
  void boot(bool only_communication, TimePoint now);
  void beat(TimePoint now);
  void watch_master(TimePoint now);
  void lose_master(std::uint16_t code);
  void react_to_loss();

  void serve(const hal::CanFrame& frame, TimePoint now);
  void answer_abort(const hal::CanFrame& request, std::uint32_t code);
  Abort may_write(const Object& object, std::uint32_t value, int bytes) const;
  Abort may_map(std::uint16_t index, std::uint32_t count) const;
  void written(std::uint16_t index, std::uint8_t sub, TimePoint now);

  void hear_sync(TimePoint now);
  void hear_pdo(int pdo, const hal::CanFrame& frame, TimePoint now);
  void unpack(int pdo, const hal::CanFrame& frame);
  void say_pdo(int pdo);
  void say_emergency(std::uint16_t code);

  void obey(std::uint16_t control_word);
  void pass_by_itself();
  void ramp(double dt_s);
  std::uint16_t status_word() const;
  bool has_profile() const;

  const int id_;
  std::map<Key, Object> objects_;
  std::vector<hal::CanFrame> said_;

  bool is_on_ = false;
  std::uint8_t nmt_ = 0;
  TimePoint last_step_ = {}, next_beat_ = {};
  std::optional<TimePoint> master_heard_, setpoint_heard_;
  std::optional<hal::CanFrame> waiting_[4];  // RPDOs until the next SYNC
  int syncs_[4] = {};
  std::uint16_t said_status_ = 0;

  Power power_ = Power::kNotReadyToSwitchOn;
  std::uint16_t control_ = 0, fault_ = 0, pending_fault_ = 0;
  bool is_comm_error_ = false;
  double demand_ = 0, velocity_ = 0;
  std::uint64_t guard_events_ = 0;
};

}  // namespace gannet::world

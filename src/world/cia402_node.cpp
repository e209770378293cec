// The CANopen side: NMT, heartbeats, SDO server, PDOs, EMCY.
#include "src/world/cia402_node.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::world {

using hal::CanFrame;
using hal::cia402::Access;
using hal::cia402::ObjectAbout;
using hal::cia402::ObjectType;

namespace {

constexpr std::uint8_t kPreOperational = 127, kOperational = 5, kStopped = 4;
constexpr std::uint32_t kOff = 0x80000000;  // a PDO's COB-ID bit 31
constexpr int kPdos = 4;
constexpr std::uint16_t kHeartbeatError = 0x8130, kRpdoTimeout = 0x8250, kPdoTooShort = 0x8210;

std::uint32_t little(const CanFrame& frame, int from, int bytes) {
  std::uint32_t value = 0;
  for (int i = bytes - 1; i >= 0; --i) {
    value = value * 256 + frame.data[static_cast<std::size_t>(from + i)];
  }
  return value;
}

std::uint8_t byte_of(std::uint32_t value, int n) {
  return static_cast<std::uint8_t>(value >> 8 * n & 0xFF);
}

std::uint32_t cut(std::uint32_t value, int bytes) {
  return bytes == 4 ? value : value & ((1u << 8 * bytes) - 1);
}

std::int64_t as_number(ObjectType type, std::uint32_t value) {
  switch (type) {
    case ObjectType::kInteger8:
      return static_cast<std::int8_t>(value);
    case ObjectType::kInteger16:
      return static_cast<std::int16_t>(value);
    case ObjectType::kInteger32:
      return static_cast<std::int32_t>(value);
    default:
      return value;
  }
}

bool is_mapping(std::uint16_t index) {
  return (index & 0xFFFC) == 0x1600 || (index & 0xFFFC) == 0x1A00;
}
bool is_pdo(std::uint16_t index) {
  return (index & 0xFFFC) == 0x1400 || (index & 0xFFFC) == 0x1800;
}

}  // namespace

Cia402Node::Cia402Node(int id) : id_(id) {
  for (const ObjectAbout& about : hal::cia402::drive_objects()) {
    objects_[{about.id.index, about.id.sub}] = {about, 0};
  }
  set_defaults(false);
}

void Cia402Node::set_defaults(bool only_communication) {
  for (auto& [key, object] : objects_) {
    if (only_communication && key.first >= 0x2000) continue;
    const std::int64_t start = object.about.start + (object.about.adds_node_id ? id_ : 0);
    object.value = cut(static_cast<std::uint32_t>(start), bytes_of(object.about.type));
  }
}

void Cia402Node::lack(std::uint16_t index, int sub) {
  std::erase_if(objects_, [&](const auto& item) {
    return item.first.first == index && (sub < 0 || item.first.second == sub);
  });
}

void Cia402Node::fix(std::uint16_t index) {
  for (auto& [key, object] : objects_) {
    if (key.first == index) object.about.access = Access::kReadOnly;
  }
}

std::uint32_t Cia402Node::get(std::uint16_t index, std::uint8_t sub) const {
  const auto found = objects_.find({index, sub});
  return found == objects_.end() ? 0 : found->second.value;
}

std::int32_t Cia402Node::get_signed(std::uint16_t index) const {
  const auto found = objects_.find({index, 0});
  if (found == objects_.end()) return 0;
  return static_cast<std::int32_t>(as_number(found->second.about.type, found->second.value));
}

void Cia402Node::set(std::uint16_t index, std::uint8_t sub, std::uint32_t value) {
  const auto found = objects_.find({index, sub});
  if (found == objects_.end()) return;
  found->second.value = cut(value, bytes_of(found->second.about.type));
}

void Cia402Node::say(std::uint32_t id, std::initializer_list<std::uint8_t> bytes) {
  CanFrame frame = {.id = id, .length = static_cast<std::uint8_t>(bytes.size())};
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  said_.push_back(frame);
}

// ---- NMT and heartbeats -------------------------------------------------------------------------

void Cia402Node::power_on(TimePoint now) {
  is_on_ = true;
  power_ = Power::kNotReadyToSwitchOn;
  control_ = 0;
  demand_ = 0;
  last_step_ = now;
  boot(false, now);
}

void Cia402Node::boot(bool only_communication, TimePoint now) {
  set_defaults(only_communication);
  nmt_ = kPreOperational;
  is_comm_error_ = false;
  master_heard_.reset();
  setpoint_heard_.reset();
  for (auto& frame : waiting_) frame.reset();
  next_beat_ = now;
  say(0x700u + static_cast<unsigned>(id_), {0});
}

void Cia402Node::hear(const CanFrame& frame, TimePoint now) {
  if (!is_on_ || frame.extended || frame.error) return;
  const auto id = static_cast<std::uint32_t>(id_);
  if (frame.id == 0) return hear_nmt(frame, now);
  if (frame.id == 0x700 + (get(0x1016, 1) >> 16 & 0x7F)) {
    if (frame.length == 1 && get(0x1016, 1) != 0) {
      master_heard_ = now;
      if (is_comm_error_) say_emergency(0);
      is_comm_error_ = false;
    }
    return;
  }
  if (nmt_ == kStopped) return;
  if (frame.id == 0x600 + id && frame.length == 8) return serve(frame, now);
  if (nmt_ != kOperational) return;
  if (frame.id == get(0x1005)) return hear_sync(now);
  for (int pdo = 0; pdo < kPdos; ++pdo) {
    const std::uint32_t cob_id = get(static_cast<std::uint16_t>(0x1400 + pdo), 1);
    if ((cob_id & kOff) == 0 && frame.id == (cob_id & 0x7FF)) hear_pdo(pdo, frame, now);
  }
}

void Cia402Node::hear_nmt(const CanFrame& frame, TimePoint now) {
  if (frame.length != 2 || (frame.data[1] != 0 && frame.data[1] != id_)) return;
  const std::uint8_t before = nmt_;
  switch (frame.data[0]) {
    case 1:
      nmt_ = kOperational;
      // Event-driven PDOs say once how things stand.
      if (before != kOperational) said_status_ = static_cast<std::uint16_t>(~status_word());
      break;
    case 2:
      nmt_ = kStopped;
      if (before == kOperational) react_to_loss();
      break;
    case 128:
      nmt_ = kPreOperational;
      break;
    case 129:
      power_on(now);
      return;
    case 130:
      boot(true, now);
      return;
    default:
      return;
  }
  setpoint_heard_.reset();
  if (nmt_ != before && get(0x1017) != 0) beat(now);
}

void Cia402Node::beat(TimePoint now) {
  say(0x700u + static_cast<unsigned>(id_), {nmt_});
  next_beat_ = now + std::chrono::milliseconds(get(0x1017));
}

void Cia402Node::watch_master(TimePoint now) {
  const std::uint32_t guard_ms = get(0x1016, 1) & 0xFFFF;
  // Watching begins with the first heartbeat.
  if (guard_ms != 0 && master_heard_ &&
      now - *master_heard_ > std::chrono::milliseconds(guard_ms)) {
    master_heard_.reset();
    lose_master(kHeartbeatError);
  }
  for (int pdo = 0; pdo < kPdos; ++pdo) {
    const std::uint32_t timer_ms = get(static_cast<std::uint16_t>(0x1400 + pdo), 5);
    const bool is_late =
        setpoint_heard_ && now - *setpoint_heard_ > std::chrono::milliseconds(timer_ms);
    if (timer_ms != 0 && nmt_ == kOperational && is_late) {
      setpoint_heard_.reset();
      lose_master(kRpdoTimeout);
    }
  }
}

void Cia402Node::lose_master(std::uint16_t code) {
  ++guard_events_;
  is_comm_error_ = true;
  say_emergency(code);
  if (objects_.count({0x6007, 0}) != 0 && get(0x6007) == 1) pending_fault_ = code;
  react_to_loss();
  if (nmt_ == kOperational && objects_.count({0x1029, 1}) != 0) {
    if (get(0x1029, 1) == 0) nmt_ = kPreOperational;
    if (get(0x1029, 1) == 2) nmt_ = kStopped;
  }
}

void Cia402Node::say_emergency(std::uint16_t code) {
  std::uint8_t error_register = 0;
  if (code != 0) {
    const int kind = code >> 12;
    error_register = 1;
    if (kind == 2) error_register |= 2;
    if (kind == 3) error_register |= 4;
    if (kind == 4) error_register |= 8;
    if (code >> 8 == 0x81 || code >> 8 == 0x82) error_register |= 16;
  }
  set(0x1001, 0, error_register);
  say(0x80u + static_cast<unsigned>(id_),
      {byte_of(code, 0), byte_of(code, 1), error_register, 0, 0, 0, 0, 0});
}

// ---- SDO server ---------------------------------------------------------------------------------

void Cia402Node::answer_abort(const CanFrame& request, std::uint32_t code) {
  say(0x580u + static_cast<unsigned>(id_),
      {0x80, request.data[1], request.data[2], request.data[3], byte_of(code, 0), byte_of(code, 1),
       byte_of(code, 2), byte_of(code, 3)});
}

void Cia402Node::serve(const CanFrame& frame, TimePoint now) {
  const auto index = static_cast<std::uint16_t>(little(frame, 1, 2));
  const std::uint8_t sub = frame.data[3], command = frame.data[0];
  const int specifier = command >> 5;
  if (specifier == 4) return;  // the client gave up
  const bool is_download = specifier == 1 && (command & 2) != 0;
  if (!is_download && specifier != 2) return answer_abort(frame, 0x05040001);
  const auto found = objects_.find({index, sub});
  if (found == objects_.end()) {
    return answer_abort(frame, objects_.count({index, 0}) != 0 ? 0x06090011 : 0x06020000);
  }
  Object& object = found->second;
  const int bytes = bytes_of(object.about.type);
  if (specifier == 2) {
    if (index == 0x6041) object.value = status_word();
    const std::uint32_t v = object.value;
    say(0x580u + static_cast<unsigned>(id_),
        {static_cast<std::uint8_t>(0x43 + 4 * (4 - bytes)), frame.data[1], frame.data[2], sub,
         byte_of(v, 0), byte_of(v, 1), byte_of(v, 2), byte_of(v, 3)});
    return;
  }
  const int size = (command & 1) != 0 ? 4 - (command >> 2 & 3) : bytes;
  const std::uint32_t value = little(frame, 4, size);
  if (const Abort abort = may_write(object, value, size); abort.code != 0) {
    return answer_abort(frame, abort.code);
  }
  object.value = value;
  say(0x580u + static_cast<unsigned>(id_), {0x60, frame.data[1], frame.data[2], sub, 0, 0, 0, 0});
  written(index, sub, now);
}

Cia402Node::Abort Cia402Node::may_write(const Object& object, std::uint32_t value,
                                        int bytes) const {
  const ObjectAbout& about = object.about;
  const std::uint16_t index = about.id.index;
  if (about.access != Access::kReadWrite) return {0x06010002};
  if (bytes != bytes_of(about.type)) {
    return {bytes > bytes_of(about.type) ? 0x06070012u : 0x06070013u};
  }
  const std::int64_t number = as_number(about.type, value);
  if (about.min != about.max && (number < about.min || number > about.max)) return {0x06090030};
  if (index == 0x6060 && number != 0 && number != 3 && number != 9) return {0x06090030};
  if (is_pdo(index) && about.id.sub == 1 && (object.value & kOff) == 0 && (value & kOff) == 0 &&
      (value & 0x7FF) != (object.value & 0x7FF)) {
    return {0x06090030};
  }
  if (is_pdo(index) && about.id.sub == 2 && value > 240 && value < 252) return {0x06090030};
  if (is_mapping(index)) {
    if ((get(index - 0x200, 1) & kOff) == 0) return {0x08000022};
    if (about.id.sub == 0) return may_map(index, value);
    if (get(index, 0) != 0) return {0x08000022};
  }
  return {};
}

Cia402Node::Abort Cia402Node::may_map(std::uint16_t index, std::uint32_t count) const {
  std::uint32_t bits = 0;
  for (std::uint32_t sub = 1; sub <= count; ++sub) {
    const std::uint32_t entry = get(index, static_cast<std::uint8_t>(sub));
    const auto found = objects_.find(
        {static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8 & 0xFF)});
    if (found == objects_.end()) return {0x06020000};
    const ObjectAbout& about = found->second.about;
    const bool is_transmit = index >= 0x1A00;
    if (is_transmit ? !about.in_tpdo : !about.in_rpdo) return {0x06040041};
    if ((entry & 0xFF) != static_cast<std::uint32_t>(8 * bytes_of(about.type))) return {0x06040041};
    bits += entry & 0xFF;
  }
  return {bits > 64 ? 0x06040042u : 0};
}

void Cia402Node::written(std::uint16_t index, std::uint8_t sub, TimePoint now) {
  if (index == 0x1016) master_heard_.reset();
  if (index == 0x1017 && get(0x1017) != 0) beat(now);
  if (is_pdo(index) && sub == 5) setpoint_heard_.reset();
  if (index == 0x6040) obey(static_cast<std::uint16_t>(get(0x6040)));
  if (index == 0x6060) set(0x6061, 0, get(0x6060));
}

// ---- PDOs ---------------------------------------------------------------------------------------

void Cia402Node::hear_sync(TimePoint) {
  for (int pdo = 0; pdo < kPdos; ++pdo) {  // what was measured up to the SYNC
    const std::uint32_t type = get(static_cast<std::uint16_t>(0x1800 + pdo), 2);
    if (type > 240 || ++syncs_[pdo] < static_cast<int>(std::max(type, 1u))) continue;
    syncs_[pdo] = 0;
    say_pdo(pdo);
  }
  for (int pdo = 0; pdo < kPdos; ++pdo) {
    if (waiting_[pdo]) unpack(pdo, *waiting_[pdo]);
    waiting_[pdo].reset();
  }
}

void Cia402Node::hear_pdo(int pdo, const CanFrame& frame, TimePoint now) {
  setpoint_heard_ = now;
  if (get(static_cast<std::uint16_t>(0x1400 + pdo), 2) <= 240) {
    waiting_[pdo] = frame;
  } else {
    unpack(pdo, frame);
  }
}

void Cia402Node::unpack(int pdo, const CanFrame& frame) {
  const auto map = static_cast<std::uint16_t>(0x1600 + pdo);
  int at = 0;
  for (std::uint32_t sub = 1; sub <= get(map, 0); ++sub) {
    at += static_cast<int>(get(map, static_cast<std::uint8_t>(sub)) & 0xFF) / 8;
  }
  if (at > frame.length) return say_emergency(kPdoTooShort);
  at = 0;
  for (std::uint32_t sub = 1; sub <= get(map, 0); ++sub) {
    const std::uint32_t entry = get(map, static_cast<std::uint8_t>(sub));
    const int bytes = static_cast<int>(entry & 0xFF) / 8;
    const auto index = static_cast<std::uint16_t>(entry >> 16);
    set(index, static_cast<std::uint8_t>(entry >> 8 & 0xFF), little(frame, at, bytes));
    if (index == 0x6060) set(0x6061, 0, get(0x6060));
    at += bytes;
  }
  obey(static_cast<std::uint16_t>(get(0x6040)));
}

void Cia402Node::say_pdo(int pdo) {
  const std::uint32_t cob_id = get(static_cast<std::uint16_t>(0x1800 + pdo), 1);
  if ((cob_id & kOff) != 0 || nmt_ != kOperational) return;
  const auto map = static_cast<std::uint16_t>(0x1A00 + pdo);
  set(0x6041, 0, status_word());
  CanFrame frame = {.id = cob_id & 0x7FF};
  for (std::uint32_t sub = 1; sub <= get(map, 0); ++sub) {
    const std::uint32_t entry = get(map, static_cast<std::uint8_t>(sub));
    const std::uint32_t value =
        get(static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>(entry >> 8 & 0xFF));
    for (int n = 0; n < static_cast<int>(entry & 0xFF) / 8; ++n) {
      frame.data[frame.length++] = byte_of(value, n);
    }
  }
  said_.push_back(frame);
}

void Cia402Node::measure(double velocity, double current_ma, double voltage_mv, double position) {
  velocity_ = velocity;
  const double rated = std::max(1u, get(0x6075));
  const auto whole = [](double value, double most) {
    return static_cast<std::int32_t>(std::lround(std::clamp(value, -most, most)));
  };
  set(0x6064, 0, static_cast<std::uint32_t>(whole(position, 2147483647)));
  set(0x606C, 0, static_cast<std::uint32_t>(whole(velocity, 2147483647)));
  set(0x6078, 0, static_cast<std::uint32_t>(whole(1000 * current_ma / rated, 32767)));
  set(0x6079, 0, static_cast<std::uint32_t>(whole(voltage_mv, 2147483647)));
}

void Cia402Node::step(TimePoint now) {
  if (!is_on_) return;
  const double dt_s = to_seconds(now - last_step_);
  last_step_ = now;
  pass_by_itself();
  ramp(dt_s);
  watch_master(now);
  if (get(0x1017) != 0 && now >= next_beat_) beat(now);
  const std::uint16_t status = status_word();
  for (int pdo = 0; pdo < kPdos && status != said_status_; ++pdo) {  // event-driven ones
    if (get(static_cast<std::uint16_t>(0x1800 + pdo), 2) >= 254) say_pdo(pdo);
  }
  said_status_ = status;
}

}  // namespace gannet::world

#include "hal/drive/cia402_objects.hpp"

#include <algorithm>

namespace gannet::hal::cia402 {
namespace {

constexpr auto kI8 = ObjectType::kInteger8, kU8 = ObjectType::kUnsigned8;
constexpr auto kI16 = ObjectType::kInteger16, kU16 = ObjectType::kUnsigned16;
constexpr auto kI32 = ObjectType::kInteger32, kU32 = ObjectType::kUnsigned32;
constexpr auto kConst = Access::kConst, kRo = Access::kReadOnly, kRw = Access::kReadWrite;

constexpr std::int64_t kNotValid = 0x80000000, kNoRtr = 0x40000000;
constexpr std::int64_t kStatusMapping = 0x60410010, kControlMapping = 0x60400010;
constexpr int kPdos = 4, kMapped = 4;

using Objects = std::vector<ObjectAbout>;

ObjectAbout ranged(ObjectAbout object, std::int64_t min, std::int64_t max) {
  object.min = min;
  object.max = max;
  return object;
}

std::uint16_t index_at(int base, int n) { return static_cast<std::uint16_t>(base + n); }

void add_communication(Objects& o) {
  o.push_back({{0x1000, 0}, "Device type", kU32, kConst, 0x00020192});  // servo drive, profile 402
  o.push_back({{0x1001, 0}, "Error register", kU8, kRo, 0, false, false, true});
  o.push_back({{0x1005, 0}, "COB-ID SYNC", kU32, kRo, 0x80});
  o.push_back({{0x1006, 0}, "Communication cycle period", kU32, kRw, 0});
  o.push_back({{0x1014, 0}, "COB-ID EMCY", kU32, kRo, 0x80, true});
  o.push_back({{0x1016, 0}, "Highest sub-index supported", kU8, kConst, 1});
  o.push_back({{0x1016, 1}, "Consumer heartbeat time 1", kU32, kRw, 0});
  o.push_back({{0x1017, 0}, "Producer heartbeat time", kU16, kRw, 0});
  o.push_back({{0x1018, 0}, "Highest sub-index supported", kU8, kConst, 4});
  o.push_back({{0x1018, 1}, "Vendor-ID", kU32, kConst, 0});  // none was assigned
  o.push_back({{0x1018, 2}, "Product code", kU32, kConst, 402});
  o.push_back({{0x1018, 3}, "Revision number", kU32, kConst, 1});
  o.push_back({{0x1018, 4}, "Serial number", kU32, kConst, 0, true});
  o.push_back({{0x1029, 0}, "Highest sub-index supported", kU8, kConst, 1});
  o.push_back(ranged({{0x1029, 1}, "Communication error", kU8, kRw, 0}, 0, 2));
  o.push_back({{0x1200, 0}, "Highest sub-index supported", kU8, kConst, 2});
  o.push_back({{0x1200, 1}, "COB-ID client to server (rx)", kU32, kRo, 0x600, true});
  o.push_back({{0x1200, 2}, "COB-ID server to client (tx)", kU32, kRo, 0x580, true});
}

// PDO 1 carries control or status word, as CiA 402 wants; the others are off and empty.
void add_pdo_communication(Objects& o, bool is_transmit) {
  for (int n = 0; n < kPdos; ++n) {
    const std::uint16_t index = index_at(is_transmit ? 0x1800 : 0x1400, n);
    const std::int64_t cob_id = (is_transmit ? 0x180 | kNoRtr : 0x200) + 0x100 * n;
    o.push_back({{index, 0}, "Highest sub-index supported", kU8, kConst, 5});
    o.push_back(
        {{index, 1}, "COB-ID used by PDO", kU32, kRw, n == 0 ? cob_id : cob_id | kNotValid, true});
    o.push_back({{index, 2}, "Transmission type", kU8, kRw, 255});
    if (is_transmit) o.push_back({{index, 3}, "Inhibit time", kU16, kRw, 0});
    o.push_back({{index, 5}, "Event timer", kU16, kRw, 0});
  }
}

void add_pdo_mapping(Objects& o, bool is_transmit) {
  for (int n = 0; n < kPdos; ++n) {
    const std::uint16_t index = index_at(is_transmit ? 0x1A00 : 0x1600, n);
    o.push_back(ranged({{index, 0}, "Number of mapped objects", kU8, kRw, n == 0}, 0, kMapped));
    for (int sub = 1; sub <= kMapped; ++sub) {
      const bool is_mapped = n == 0 && sub == 1;
      const std::int64_t what = is_transmit ? kStatusMapping : kControlMapping;
      o.push_back({{index, static_cast<std::uint8_t>(sub)},
                   "Mapped object " + std::to_string(sub),
                   kU32,
                   kRw,
                   is_mapped ? what : 0});
    }
  }
}

void add_profile(Objects& o) {
  const bool yes = true, no = false;
  o.push_back(ranged({{0x6007, 0}, "Abort connection option code", kI16, kRw, 1}, 0, 3));
  o.push_back({{0x603F, 0}, "Error code", kU16, kRo, 0, no, no, yes});
  o.push_back({{0x6040, 0}, "Controlword", kU16, kRw, 0, no, yes, yes});
  o.push_back({{0x6041, 0}, "Statusword", kU16, kRo, 0, no, no, yes});
  o.push_back(ranged({{0x605A, 0}, "Quick stop option code", kI16, kRw, 2}, 0, 6));
  o.push_back(ranged({{0x605B, 0}, "Shutdown option code", kI16, kRw, 0}, 0, 1));
  o.push_back(ranged({{0x605C, 0}, "Disable operation option code", kI16, kRw, 1}, 0, 1));
  o.push_back(ranged({{0x605D, 0}, "Halt option code", kI16, kRw, 1}, 1, 2));
  o.push_back(ranged({{0x605E, 0}, "Fault reaction option code", kI16, kRw, 2}, 0, 2));
  o.push_back({{0x6060, 0}, "Modes of operation", kI8, kRw, 0, no, yes, yes});
  o.push_back({{0x6061, 0}, "Modes of operation display", kI8, kRo, 0, no, no, yes});
  o.push_back({{0x6064, 0}, "Position actual value", kI32, kRo, 0, no, no, yes});
  o.push_back({{0x606C, 0}, "Velocity actual value", kI32, kRo, 0, no, no, yes});
  o.push_back({{0x6075, 0}, "Motor rated current", kU32, kRw, 10000});
  o.push_back({{0x6078, 0}, "Current actual value", kI16, kRo, 0, no, no, yes});
  o.push_back({{0x6079, 0}, "DC link circuit voltage", kU32, kRo, 0, no, no, yes});
  o.push_back({{0x6083, 0}, "Profile acceleration", kU32, kRw, 100000});
  o.push_back({{0x6084, 0}, "Profile deceleration", kU32, kRw, 100000});
  o.push_back({{0x6085, 0}, "Quick stop deceleration", kU32, kRw, 200000});
  o.push_back({{0x60C2, 0}, "Highest sub-index supported", kU8, kConst, 2});
  o.push_back({{0x60C2, 1}, "Interpolation time period value", kU8, kRw, 1});
  o.push_back(ranged({{0x60C2, 2}, "Interpolation time index", kI8, kRw, -3}, -6, 0));
  o.push_back({{0x60FF, 0}, "Target velocity", kI32, kRw, 0, no, yes, yes});
  o.push_back({{0x6502, 0}, "Supported drive modes", kU32, kConst, 0x104});  // pv 2, csv 8
}

}  // namespace

int bytes_of(ObjectType type) {
  switch (type) {
    case ObjectType::kInteger8:
    case ObjectType::kUnsigned8:
      return 1;
    case ObjectType::kInteger16:
    case ObjectType::kUnsigned16:
      return 2;
    case ObjectType::kInteger32:
    case ObjectType::kUnsigned32:
      return 4;
  }
  return 4;
}

Objects drive_objects() {
  Objects objects;
  add_communication(objects);
  add_pdo_communication(objects, false);
  add_pdo_mapping(objects, false);
  add_pdo_communication(objects, true);
  add_pdo_mapping(objects, true);
  add_profile(objects);
  std::sort(objects.begin(), objects.end(), [](const ObjectAbout& a, const ObjectAbout& b) {
    return a.id.index != b.id.index ? a.id.index < b.id.index : a.id.sub < b.id.sub;
  });
  return objects;
}

}  // namespace gannet::hal::cia402

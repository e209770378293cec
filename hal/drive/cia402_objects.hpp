// The object dictionary of a CiA 402 velocity drive as Gannet uses it, described once: of this the
// simulated drive is made, and the EDS that tools decode logs with. Source of indices, types,
// names and defaults: CiA 301 (1xxx), CiA 402-2 (6xxx); the EDS's form: CiA 306.
// Start-up only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/drive/canopen_sdo.hpp"

namespace gannet::hal::cia402 {

// The numbers are CiA 301's data types.
enum class ObjectType : std::uint8_t {
  kInteger8 = 0x02,
  kInteger16 = 0x03,
  kInteger32 = 0x04,
  kUnsigned8 = 0x05,
  kUnsigned16 = 0x06,
  kUnsigned32 = 0x07,
};
int bytes_of(ObjectType type);

enum class Access : std::uint8_t { kConst, kReadOnly, kReadWrite };

struct ObjectAbout {
  canopen::ObjectId id;
  std::string name;
  ObjectType type = ObjectType::kUnsigned32;
  Access access = Access::kReadWrite;
  std::int64_t start = 0;                 // value after power-on
  bool adds_node_id = false;              // start is to be taken plus the node id
  bool in_rpdo = false, in_tpdo = false;  // may be mapped
  std::int64_t min = 0, max = 0;          // of what may be written; equal: whatever the type holds
};

// Ordered by index and sub-index.
std::vector<ObjectAbout> drive_objects();

// The electronic data sheet of drive_objects().
std::string eds_text();

}  // namespace gannet::hal::cia402

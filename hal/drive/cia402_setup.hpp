// What is asked of and written to a CiA 402 drive before it may run, as a list of SDO steps: what
// it is, its heartbeat, its PDOs with their mapping read back, mode of operation, quick stop, and
// that it stops by itself when our heartbeat stays away. Source: CiA 301, 7.5.2 (communication
// objects; the order in which a PDO is changed: 7.5.2.36) and CiA 402-2 (6xxx).
// Made at start-up; read on the servo thread, RT safe.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/drive/canopen_sdo.hpp"
#include "hal/drive/cia402_config.hpp"

namespace gannet::hal::cia402 {

using canopen::ObjectId;

struct SetupStep {
  enum class Kind : std::uint8_t {
    kWrite,       // must be taken
    kOffer,       // may be refused: the drive has no such object, or has it fixed
    kExpect,      // read: must be there and have this value
    kExpectSoon,  // the same, asked again for half a second
    kLearn,       // read, may be missing: says what fact says
  };
  enum class Fact : std::uint8_t {
    kNone,
    kConsumer,      // 1016 watches our heartbeat
    kReaction,      // 6007 does something
    kRpdoTimer,     // 1400:5 watches our setpoints
    kRatedCurrent,  // 6075, mA
  };
  Kind kind = Kind::kOffer;
  ObjectId object;
  int bytes = 4;
  std::uint32_t value = 0;
  std::uint32_t mask = 0xFFFFFFFF;
  Fact fact = Fact::kNone;
  bool only_unguarded = false;  // skipped when the drive watches our heartbeat
};

std::vector<SetupStep> setup_steps(const Cia402Config& config, int node, int own_node_id);

// The length of the drive's transmit PDO and of ours, by the config.
constexpr int kRpdoBytes = 6;
constexpr int kPositionBytes = 4;
inline int tpdo_bytes(const Cia402Config& config) { return config.report_current ? 8 : 6; }

}  // namespace gannet::hal::cia402

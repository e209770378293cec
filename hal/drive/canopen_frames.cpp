#include "hal/drive/canopen_frames.hpp"

#include <algorithm>

namespace gannet::hal::canopen {
namespace {

struct Words {
  std::uint16_t code, mask;
  const char* text;
};

// The first that matches, so the narrow ones stand before their class.
constexpr Words kEmergencies[] = {
    {0x0000, 0xFF00, "no error"},
    {0x2110, 0xFFF0, "short circuit or earth leakage at the input"},
    {0x2220, 0xFFF0, "continuous over-current inside the drive"},
    {0x2230, 0xFFF0, "short circuit or earth leakage inside the drive"},
    {0x2310, 0xFFF0, "continuous over-current at the motor"},
    {0x2320, 0xFFF0, "short circuit or earth leakage at the motor"},
    {0x2330, 0xFFF0, "earth leakage at the motor"},
    {0x2340, 0xFFF0, "short circuit at the motor"},
    {0x2000, 0xF000, "current"},
    {0x3110, 0xFFF0, "mains over-voltage"},
    {0x3120, 0xFFF0, "mains under-voltage"},
    {0x3130, 0xFFF0, "mains phase failure"},
    {0x3210, 0xFFF0, "DC link over-voltage"},
    {0x3220, 0xFFF0, "DC link under-voltage"},
    {0x3310, 0xFFF0, "output over-voltage"},
    {0x3000, 0xF000, "voltage"},
    {0x4110, 0xFFF0, "ambient temperature too high"},
    {0x4210, 0xFFF0, "drive temperature too high"},
    {0x4310, 0xFFF0, "power stage temperature too high"},
    {0x4000, 0xF000, "temperature"},
    {0x5110, 0xFFF0, "low-voltage supply"},
    {0x5400, 0xFF00, "power section"},
    {0x5500, 0xFF00, "memory"},
    {0x5000, 0xF000, "drive hardware"},
    {0x6010, 0xFFF0, "drive restarted"},
    {0x6320, 0xFFF0, "a parameter is wrong"},
    {0x6000, 0xF000, "drive software"},
    {0x7110, 0xFFF0, "brake chopper"},
    {0x7121, 0xFFFF, "motor blocked"},
    {0x7122, 0xFFFF, "motor or commutation"},
    {0x7120, 0xFFF0, "motor"},
    {0x7305, 0xFFFF, "incremental encoder"},
    {0x7300, 0xFF00, "sensor"},
    {0x7500, 0xFF00, "communication inside the drive"},
    {0x7000, 0xF000, "additional module"},
    {0x8110, 0xFFFF, "CAN overrun, frames lost"},
    {0x8120, 0xFFFF, "CAN error passive"},
    {0x8130, 0xFFFF, "heartbeat lost"},
    {0x8140, 0xFFFF, "recovered from bus-off"},
    {0x8150, 0xFFFF, "CAN id collision"},
    {0x8100, 0xFF00, "CAN communication"},
    {0x8210, 0xFFFF, "PDO too short"},
    {0x8220, 0xFFFF, "PDO too long"},
    {0x8240, 0xFFFF, "SYNC of unexpected length"},
    {0x8250, 0xFFF0, "RPDO timed out"},
    {0x8200, 0xFF00, "protocol"},
    {0x8300, 0xFF00, "torque control"},
    {0x8400, 0xFF00, "velocity control"},
    {0x8500, 0xFF00, "position control"},
    {0x8611, 0xFFFF, "following error"},
    {0x8600, 0xFF00, "positioning"},
    {0x8700, 0xFF00, "synchronisation"},
    {0x8000, 0xF000, "monitoring"},
    {0x9000, 0xF000, "external error"},
    {0xF001, 0xFFFF, "the drive disabled itself"},  // these two are ours: see Trip
    {0xF002, 0xFFFF, "the drive did not enable"},
    {0xF000, 0xFF00, "additional function"},
    {0xFF00, 0xFF00, "the maker's own error"},
    {0x1000, 0xFF00, "generic error"},
};

}  // namespace

void put(std::span<std::uint8_t> bytes, std::uint64_t value) {
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(value);
    value >>= 8;
  }
}

std::uint32_t get(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i > 0; --i) value = value << 8 | bytes[i - 1];
  return value;
}

CanFrame nmt_frame(NmtCommand command, int node) {
  return {.id = kNmtId,
          .length = 2,
          .data = {static_cast<std::uint8_t>(command), static_cast<std::uint8_t>(node)}};
}

CanFrame sync_frame() { return {.id = kSyncId}; }

CanFrame heartbeat_frame(int node, NmtState state) {
  return {.id = kHeartbeatBase + static_cast<std::uint32_t>(node),
          .length = 1,
          .data = {static_cast<std::uint8_t>(state)}};
}

std::optional<NmtState> heartbeat_from(const CanFrame& frame) {
  if (frame.length != 1) return {};
  const std::uint8_t state = frame.data[0] & 0x7F;  // bit 7 toggles in node guarding's answers
  for (const NmtState known :
       {NmtState::kBootUp, NmtState::kStopped, NmtState::kOperational, NmtState::kPreOperational}) {
    if (state == static_cast<std::uint8_t>(known)) return known;
  }
  return {};
}

std::optional<Emergency> emergency_from(const CanFrame& frame) {
  if (frame.length != 8) return {};
  const std::span<const std::uint8_t> data = frame.data;
  Emergency e = {.code = static_cast<std::uint16_t>(get(data.first(2))), .error_register = data[2]};
  std::copy(data.begin() + 3, data.end(), e.vendor.begin());
  return e;
}

const char* words_of_emergency(std::uint16_t code) {
  for (const Words& words : kEmergencies) {
    if ((code & words.mask) == words.code) return words.text;
  }
  return "unknown error";
}

}  // namespace gannet::hal::canopen

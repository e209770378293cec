// CANopen frames: NMT, SYNC, heartbeat and EMCY, and what their codes mean in words. SDO is in
// canopen_sdo.hpp. Source: CiA 301 (predefined connection set, 7.3.5; NMT, 7.2.8; EMCY, 7.2.7);
// the EMCY codes above the general ones are those of CiA 402 (IEC 61800-7-201, annex on error
// codes).
//   id 000 NMT: command, node     080 SYNC      080 + node EMCY: code 16, register 8, vendor 40
//   180, 280, 380, 480 + node: TPDO 1 … 4       200, 300, 400, 500 + node: RPDO 1 … 4
//   580 + node: SDO answer        600 + node: SDO request        700 + node: heartbeat, boot-up
// Numbers go low byte first. Values; RT safe.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/can/can_frame.hpp"

namespace gannet::hal::canopen {

inline constexpr int kMaxNodeId = 127;  // 1 … 127; in NMT 0 is all

inline constexpr std::uint32_t kNmtId = 0x000, kSyncId = 0x080;
inline constexpr std::uint32_t kEmcyBase = 0x080, kSdoAnswerBase = 0x580, kSdoRequestBase = 0x600,
                               kHeartbeatBase = 0x700;
// pdo: 1 … 4.
constexpr std::uint32_t tpdo_base(int pdo) { return 0x080 + 0x100 * static_cast<unsigned>(pdo); }
constexpr std::uint32_t rpdo_base(int pdo) { return 0x100 + 0x100 * static_cast<unsigned>(pdo); }

enum class NmtCommand : std::uint8_t {
  kStart = 0x01,
  kStop = 0x02,
  kPreOperational = 0x80,
  kResetNode = 0x81,
  kResetCommunication = 0x82,
};

enum class NmtState : std::uint8_t {
  kBootUp = 0x00,
  kStopped = 0x04,
  kOperational = 0x05,
  kPreOperational = 0x7F,
};

CanFrame nmt_frame(NmtCommand command, int node);
CanFrame sync_frame();
CanFrame heartbeat_frame(int node, NmtState state);

// The state that a heartbeat says; empty: no such state, or another length than one byte.
std::optional<NmtState> heartbeat_from(const CanFrame& frame);

struct Emergency {
  std::uint16_t code = 0;           // 0: the error is gone
  std::uint8_t error_register = 0;  // object 1001
  std::array<std::uint8_t, 5> vendor = {};
};
std::optional<Emergency> emergency_from(const CanFrame& frame);

// "heartbeat lost" for 0x8130; a code that has no words of its own gets those of its class; never
// null.
const char* words_of_emergency(std::uint16_t code);

// Little-endian numbers within a frame's data; the caller has checked the length.
void put(std::span<std::uint8_t> bytes, std::uint64_t value);
std::uint32_t get(std::span<const std::uint8_t> bytes);

}  // namespace gannet::hal::canopen

// The DroneCAN data types that drives need, each described once: members, bits, and the type's
// facts. Names and layout are those of the public DSDL (in the comments); signatures are the
// published ones. Units as on the wire. Values; RT safe.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "hal/drive/dronecan_bits.hpp"
#include "hal/drive/dronecan_transfer.hpp"
#include "platform/base/fixed_vector.hpp"

namespace gannet::hal::dronecan {

struct TypeFacts {
  std::string_view name;
  std::uint16_t id;
  std::uint64_t signature;
};

// uavcan.protocol.NodeStatus: each node at least once a second.
struct NodeStatus {
  static constexpr TypeFacts kType = {"uavcan.protocol.NodeStatus", 341, 0x0F0868D0C1A7C6F1};
  enum Health : std::uint8_t { kOk, kWarning, kError, kCritical };
  enum Mode : std::uint8_t {
    kOperational = 0,
    kInitialization = 1,
    kMaintenance = 2,
    kSoftwareUpdate = 3,
    kOffline = 7
  };
  std::uint32_t uptime_s = 0;
  std::uint8_t health = kOk;
  std::uint8_t mode = kOperational;
  std::uint8_t sub_mode = 0;
  std::uint16_t vendor_status = 0;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    b.field(m.uptime_s, 32);
    b.field(m.health, 2);
    b.field(m.mode, 3);
    b.field(m.sub_mode, 3);
    b.field(m.vendor_status, 16);
  }
};

// uavcan.equipment.esc.RawCommand: −8192 … 8191 for each ESC index.
struct RawCommand {
  static constexpr TypeFacts kType = {"uavcan.equipment.esc.RawCommand", 1030, 0x217F5C87D7EC951D};
  static constexpr int kMaxEscs = 20;
  FixedVector<std::int16_t, kMaxEscs> commands;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    b.array(m.commands, 0, [](auto& bits, auto& command) { bits.field(command, 14); });
  }
};

// uavcan.equipment.esc.Status: what a node does not know is NaN.
struct EscStatus {
  static constexpr TypeFacts kType = {"uavcan.equipment.esc.Status", 1034, 0xA9AF28AEA2FBB254};
  std::uint32_t error_count = 0;
  float voltage_v = 0;
  float current_a = 0;
  float temperature_k = 0;
  std::int32_t rpm = 0;
  std::uint8_t power_percent = 0;
  std::uint8_t esc_index = 0;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    b.field(m.error_count, 32);
    b.half(m.voltage_v);
    b.half(m.current_a);
    b.half(m.temperature_k);
    b.field(m.rpm, 18);
    b.field(m.power_percent, 7);
    b.field(m.esc_index, 5);
  }
};

// uavcan.equipment.safety.ArmingStatus: some nodes turn nothing before they have seen kArmed.
struct ArmingStatus {
  static constexpr TypeFacts kType = {"uavcan.equipment.safety.ArmingStatus", 1100,
                                      0x8700F375556A8003};
  static constexpr std::uint8_t kDisarmed = 0, kArmed = 255;
  std::uint8_t status = kDisarmed;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    b.field(m.status, 8);
  }
};

// uavcan.protocol.GetNodeInfo, the answer; the request is empty.
struct NodeInfo {
  static constexpr TypeFacts kType = {"uavcan.protocol.GetNodeInfo", 1, 0xEE468A8121C46A9E};
  NodeStatus status;
  std::uint8_t software_major = 0, software_minor = 0;
  std::uint8_t software_flags = 0;  // 1: the commit is there, 2: the image's CRC
  std::uint32_t software_commit = 0;
  std::uint64_t software_crc = 0;
  std::uint8_t hardware_major = 0, hardware_minor = 0;
  std::array<std::uint8_t, 16> unique_id = {};
  FixedVector<std::uint8_t, 255> certificate;
  FixedVector<std::uint8_t, 80> name;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    constexpr auto byte = [](auto& bits, auto& value) { bits.field(value, 8); };
    NodeStatus::describe_bits(m.status, b);
    byte(b, m.software_major);
    byte(b, m.software_minor);
    byte(b, m.software_flags);
    b.field(m.software_commit, 32);
    b.field(m.software_crc, 64);
    byte(b, m.hardware_major);
    byte(b, m.hardware_minor);
    for (auto& value : m.unique_id) byte(b, value);
    b.array(m.certificate, 8, byte);
    b.array(m.name, 0, byte);
  }
  void set_name(std::string_view text);
};

// uavcan.protocol.dynamic_node_id.Allocation: a node without an id asks for one.
struct Allocation {
  static constexpr TypeFacts kType = {"uavcan.protocol.dynamic_node_id.Allocation", 1,
                                      0x0B2A812620A11D40};
  std::uint8_t node_id = 0;
  bool is_first_part = false;
  FixedVector<std::uint8_t, 16> unique_id;

  template <class Self, class Bits>
  static void describe_bits(Self& m, Bits& b) {
    b.field(m.node_id, 7);
    b.field(m.is_first_part, 1);
    b.array(m.unique_id, 0, [](auto& bits, auto& value) { bits.field(value, 8); });
  }
};

// The payload's bytes; 0 also if out is too small, which kMaxPayload never is.
template <class Message>
int encode(const Message& message, std::span<std::uint8_t> out) {
  BitWriter writer(out);
  Message::describe_bits(message, writer);
  return writer.is_good() ? writer.bytes() : 0;
}

// False: too short, too long, or an array above its greatest length.
template <class Message>
bool decode(std::span<const std::uint8_t> payload, Message& message) {
  BitReader reader(payload);
  Message::describe_bits(message, reader);
  return reader.is_good() && reader.left() < 8;
}

// A message's frames, into out; 0 when out has too little room.
template <class Message>
int to_frames(const Message& message, const TransferHeader& header, std::span<CanFrame> out) {
  std::array<std::uint8_t, kMaxPayload> payload;
  const int size = encode(message, payload);
  return disassemble(header, Message::kType.signature,
                     std::span(payload).first(static_cast<std::size_t>(size)), out);
}

template <class Message>
constexpr Subscription subscription_to(TransferKind kind = TransferKind::kMessage) {
  return {kind, Message::kType.id, Message::kType.signature};
}

}  // namespace gannet::hal::dronecan

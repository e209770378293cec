// DroneCAN (UAVCAN v0) transfers: payloads of up to some hundred bytes in classic CAN frames.
// Source: DroneCAN specification, chapter 4.1 "CAN bus transport layer".
//   id, message:  priority 5 | type 16 | 0 | source 7        (bits 28 … 0)
//   id, service:  priority 5 | type 8 | request 1 | destination 7 | 1 | source 7
//   id, anonymous: priority 5 | discriminator 14 | type 2 | 0 | 0
//   last data byte ("tail"): start 1 | end 1 | toggle 1 | transfer id 5
// A payload of more than 7 bytes goes as several frames and begins with its CRC, which is seeded
// with the data type's signature. No I/O, no clock. Values and fixed memory; RT safe after
// creation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/can/can_frame.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal::dronecan {

inline constexpr int kMaxPayload = 384;  // the longest of ours, a GetNodeInfo answer, has 377
inline constexpr int kMaxNodeId = 127;   // 1 … 127; 0: anonymous, or all
inline constexpr int kTransferIds = 32;  // they count modulo 32

enum class TransferKind : std::uint8_t { kMessage, kRequest, kResponse };

struct TransferHeader {
  TransferKind kind = TransferKind::kMessage;
  std::uint16_t type_id = 0;
  std::uint8_t priority = 16;    // 0 highest … 31
  std::uint8_t source = 0;       // 0: anonymous
  std::uint8_t destination = 0;  // of a service, 1 … 127
  std::uint8_t transfer_id = 0;  // 0 … 31
};

// A data type that somebody listens to.
struct Subscription {
  TransferKind kind = TransferKind::kMessage;
  std::uint16_t type_id = 0;
  std::uint64_t signature = 0;
};

std::uint16_t transfer_crc(std::uint64_t signature, std::span<const std::uint8_t> payload);

// Frames that a payload of this size takes.
constexpr int frames_of(int payload_size) {
  return payload_size <= 7 ? 1 : (payload_size + 2 + 6) / 7;
}

// Writes the transfer's frames to out and returns how many; 0 when out has too little room.
int disassemble(const TransferHeader& header, std::uint64_t signature,
                std::span<const std::uint8_t> payload, std::span<CanFrame> out);

// What a frame's id says; empty for what is no DroneCAN frame (11-bit id, no tail byte, a service
// of or to nobody).
std::optional<TransferHeader> header_of(const CanFrame& frame);

// The frames of one data type, of any source; service: only those to that node.
CanFilter filter_for(const Subscription& subscription, int own_node_id);

struct Transfer {
  TransferHeader header;
  std::span<const std::uint8_t> payload;  // valid until the next frame
};

struct TransferCounters {
  std::uint64_t received = 0;    // whole transfers
  std::uint64_t malformed = 0;   // no tail byte, wrong CRC, too long, a start without its due form
  std::uint64_t lost = 0;        // by gaps in the transfer ids
  std::uint64_t incomplete = 0;  // begun, never ended
  std::uint64_t repeated = 0;    // frames that had been there already
  std::uint64_t no_room = 0;     // more sources than sessions
};

// Puts transfers together again. One session for each (kind, type, source), in memory taken at
// creation; a session silent for two seconds begins afresh, and its place may be taken.
class TransferReceiver {
 public:
  TransferReceiver(std::vector<Subscription> subscriptions, int own_node_id,
                   int max_sessions = 384);

  // The transfer that this frame completes, if any. Frames of other types, to other nodes, and
  // of other protocols with 11-bit ids are ignored.
  std::optional<Transfer> receive(const CanFrame& frame, TimePoint time);

  const TransferCounters& counters() const { return counters_; }

 private:
  struct Session {
    TransferHeader header;
    TimePoint start = {};  // of the newest transfer
    std::uint16_t size = 0;
    std::uint8_t expected_id = 0;
    bool toggle = false;
    bool is_under_way = false;  // frames of a transfer are in the payload
    std::array<std::uint8_t, kMaxPayload + 2> payload = {};
  };
  struct Tail;

  const Subscription* find(const TransferHeader& header) const;
  Session* session_of(const TransferHeader& header, TimePoint time);
  bool is_expected(Session& session, const Tail& tail, TimePoint time);
  void restart(Session& session, const Tail& tail, TimePoint time);
  bool append(Session& session, std::span<const std::uint8_t> data);
  std::optional<Transfer> finish(Session& session, const Tail& tail, std::uint64_t signature);

  std::vector<Subscription> subscriptions_;
  int own_node_id_;
  std::vector<std::uint32_t> keys_;  // of the sessions in use, beside them for a fast search
  std::vector<Session> sessions_;
  std::array<std::uint8_t, 8> single_ = {};  // an anonymous transfer's payload
  TransferCounters counters_;
};

}  // namespace gannet::hal::dronecan

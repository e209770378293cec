#include "hal/drive/dronecan_transfer.hpp"

#include <algorithm>

namespace gannet::hal::dronecan {
namespace {

constexpr Duration kTransferIdTimeout = std::chrono::seconds(2);  // the specification's
constexpr int kDataPerFrame = 7;

constexpr std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {  // CRC-16-CCITT-FALSE
  crc = static_cast<std::uint16_t>(crc ^ (byte << 8));
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? (crc << 1) ^ 0x1021 : crc << 1);
  }
  return crc;
}

std::uint32_t id_of(const TransferHeader& h, std::span<const std::uint8_t> payload) {
  const std::uint32_t priority = static_cast<std::uint32_t>(h.priority & 31) << 24;
  if (h.kind != TransferKind::kMessage) {
    const std::uint32_t request = h.kind == TransferKind::kRequest ? 1u << 15 : 0;
    return priority | static_cast<std::uint32_t>(h.type_id & 0xFF) << 16 | request |
           static_cast<std::uint32_t>(h.destination & 0x7F) << 8 | 0x80 | (h.source & 0x7Fu);
  }
  if (h.source != 0) return priority | static_cast<std::uint32_t>(h.type_id) << 8 | h.source;
  // Different data must have different ids: the data's own CRC makes the discriminator.
  const std::uint32_t discriminator = transfer_crc(0, payload) & 0x3FFF;
  return priority | discriminator << 10 | (h.type_id & 3u) << 8;
}

std::uint32_t key_of(const TransferHeader& h) {
  return static_cast<std::uint32_t>(h.kind) << 24 | static_cast<std::uint32_t>(h.type_id) << 8 |
         h.source;
}

// How often a must be incremented to become b.
constexpr int forward_distance(int a, int b) { return (b - a + kTransferIds) % kTransferIds; }

}  // namespace

struct TransferReceiver::Tail {
  explicit Tail(std::uint8_t byte)
      : start((byte & 0x80) != 0),
        end((byte & 0x40) != 0),
        toggle((byte & 0x20) != 0),
        id(byte & 0x1F) {}
  bool start, end, toggle;
  std::uint8_t id;
};

std::uint16_t transfer_crc(std::uint64_t signature, std::span<const std::uint8_t> payload) {
  std::uint16_t crc = 0xFFFF;
  for (int i = 0; i < 8; ++i) crc = crc_add(crc, static_cast<std::uint8_t>(signature >> (8 * i)));
  for (std::uint8_t byte : payload) crc = crc_add(crc, byte);
  return crc;
}

int disassemble(const TransferHeader& header, std::uint64_t signature,
                std::span<const std::uint8_t> payload, std::span<CanFrame> out) {
  const int size = static_cast<int>(payload.size());
  const int count = frames_of(size);
  const bool is_single = count == 1;
  if (static_cast<std::size_t>(count) > out.size() || (header.source == 0 && !is_single)) return 0;
  const std::uint16_t crc = is_single ? 0 : transfer_crc(signature, payload);
  int next = is_single ? 0 : -2;  // the CRC lies before the payload
  for (int i = 0; i < count; ++i) {
    CanFrame& frame = out[static_cast<std::size_t>(i)];
    frame = {.id = id_of(header, payload), .extended = true};
    for (; next < size && frame.length < kDataPerFrame; ++next) {
      frame.data[frame.length++] = next < 0 ? static_cast<std::uint8_t>(crc >> (8 * (next + 2)))
                                            : payload[static_cast<std::size_t>(next)];
    }
    const int tail = (i == 0 ? 0x80 : 0) | (i == count - 1 ? 0x40 : 0) | (i % 2 == 1 ? 0x20 : 0) |
                     (header.transfer_id & 0x1F);
    frame.data[frame.length++] = static_cast<std::uint8_t>(tail);
  }
  return count;
}

std::optional<TransferHeader> header_of(const CanFrame& frame) {
  if (!frame.extended || frame.error || frame.length == 0 || frame.length > 8) return {};
  TransferHeader h;
  h.priority = static_cast<std::uint8_t>(frame.id >> 24 & 31);
  h.source = static_cast<std::uint8_t>(frame.id & 0x7F);
  h.transfer_id = frame.data[frame.length - 1u] & 0x1F;
  if ((frame.id & 0x80) == 0) {
    h.type_id = static_cast<std::uint16_t>(frame.id >> 8 & (h.source == 0 ? 3 : 0xFFFF));
    return h;
  }
  h.kind = (frame.id & 0x8000) != 0 ? TransferKind::kRequest : TransferKind::kResponse;
  h.type_id = static_cast<std::uint16_t>(frame.id >> 16 & 0xFF);
  h.destination = static_cast<std::uint8_t>(frame.id >> 8 & 0x7F);
  if (h.source == 0 || h.destination == 0) return {};
  return h;
}

CanFilter filter_for(const Subscription& subscription, int own_node_id) {
  const std::uint32_t type = subscription.type_id;
  if (subscription.kind == TransferKind::kMessage) {
    // Types 0 … 3 may come anonymously, with the discriminator in the type's upper bits.
    const std::uint32_t mask = type <= 3 ? 0x000380 : 0xFFFF80;
    return {.id = type << 8, .mask = mask, .extended = true};
  }
  const std::uint32_t request = subscription.kind == TransferKind::kRequest ? 0x8000 : 0;
  return {.id = type << 16 | request | static_cast<std::uint32_t>(own_node_id) << 8 | 0x80,
          .mask = 0xFFFF80,
          .extended = true};
}

// ---- reception ----------------------------------------------------------------------------------

TransferReceiver::TransferReceiver(std::vector<Subscription> subscriptions, int own_node_id,
                                   int max_sessions)
    : subscriptions_(std::move(subscriptions)),
      own_node_id_(own_node_id),
      sessions_(static_cast<std::size_t>(max_sessions)) {
  keys_.reserve(sessions_.size());
}

const Subscription* TransferReceiver::find(const TransferHeader& header) const {
  const bool is_for_others =
      header.kind != TransferKind::kMessage && header.destination != own_node_id_;
  if (is_for_others) return nullptr;
  for (const Subscription& s : subscriptions_) {
    if (s.kind == header.kind && s.type_id == header.type_id) return &s;
  }
  return nullptr;
}

TransferReceiver::Session* TransferReceiver::session_of(const TransferHeader& header,
                                                        TimePoint time) {
  const std::uint32_t key = key_of(header);
  const auto found = std::find(keys_.begin(), keys_.end(), key);
  if (found != keys_.end()) return &sessions_[static_cast<std::size_t>(found - keys_.begin())];
  std::size_t place = keys_.size();
  if (place < sessions_.size()) {
    keys_.push_back(key);
  } else {
    place = 0;
    while (place < sessions_.size() && time - sessions_[place].start <= kTransferIdTimeout) ++place;
    if (place == sessions_.size()) return nullptr;
    keys_[place] = key;
  }
  Session& session = sessions_[place];
  session.start = time - 2 * kTransferIdTimeout;  // as one that has been silent for long
  session.is_under_way = false;
  return &session;
}

std::optional<Transfer> TransferReceiver::receive(const CanFrame& frame, TimePoint time) {
  const auto header = header_of(frame);
  if (!header) {
    if (frame.extended && !frame.error) ++counters_.malformed;
    return {};
  }
  const Subscription* subscription = find(*header);
  if (subscription == nullptr) return {};
  const Tail tail(frame.data[frame.length - 1u]);
  const auto data = std::span(frame.data).first(frame.length - 1u);
  // A lone or first frame has toggle 0, and all but the last frame are full.
  if ((tail.start && tail.toggle) || (!tail.end && frame.length != 8) ||
      (header->source == 0 && !(tail.start && tail.end))) {
    ++counters_.malformed;
    return {};
  }
  if (header->source == 0) {
    std::copy(data.begin(), data.end(), single_.begin());
    ++counters_.received;
    return Transfer{*header, std::span(single_).first(data.size())};
  }
  Session* session = session_of(*header, time);
  if (session == nullptr) {
    ++counters_.no_room;
    return {};
  }
  if (!is_expected(*session, tail, time)) return {};
  session->header = *header;
  if (!append(*session, data)) return {};
  return tail.end ? finish(*session, tail, subscription->signature) : std::nullopt;
}

// The specification's state update for a single interface.
bool TransferReceiver::is_expected(Session& session, const Tail& tail, TimePoint time) {
  const bool is_timed_out = time - session.start > kTransferIdTimeout;
  const bool is_not_previous = forward_distance(tail.id, session.expected_id) > 1;
  if (is_timed_out || (tail.start && is_not_previous)) {
    if (session.is_under_way) ++counters_.incomplete;
    if (!is_timed_out) {
      const int missed = forward_distance(session.expected_id, tail.id);
      counters_.lost += static_cast<std::uint64_t>(missed - (session.is_under_way ? 1 : 0));
    }
    restart(session, tail, time);
    if (!tail.start) {  // its beginning was missed: wait for the next
      session.expected_id = static_cast<std::uint8_t>((tail.id + 1) % kTransferIds);
      session.start = time;
      return false;
    }
  }
  if (tail.id != session.expected_id || tail.toggle != session.toggle ||
      tail.start == session.is_under_way) {
    ++counters_.repeated;
    return false;
  }
  if (tail.start) session.start = time;
  return true;
}

void TransferReceiver::restart(Session& session, const Tail& tail, TimePoint time) {
  session.start = time;
  session.expected_id = tail.id;
  session.toggle = false;
  session.is_under_way = false;
  session.size = 0;
}

bool TransferReceiver::append(Session& session, std::span<const std::uint8_t> data) {
  if (!session.is_under_way) session.size = 0;
  if (session.size + data.size() > session.payload.size()) {
    ++counters_.malformed;
    session.is_under_way = false;
    session.toggle = false;
    session.expected_id = static_cast<std::uint8_t>((session.expected_id + 1) % kTransferIds);
    return false;
  }
  std::copy(data.begin(), data.end(), session.payload.begin() + session.size);
  session.size = static_cast<std::uint16_t>(session.size + data.size());
  session.is_under_way = true;
  session.toggle = !session.toggle;
  return true;
}

std::optional<Transfer> TransferReceiver::finish(Session& session, const Tail& tail,
                                                 std::uint64_t signature) {
  session.expected_id = static_cast<std::uint8_t>((tail.id + 1) % kTransferIds);
  session.is_under_way = false;
  session.toggle = false;
  auto payload = std::span<const std::uint8_t>(session.payload).first(session.size);
  if (!tail.start) {
    const bool has_crc = payload.size() >= 2;
    const int crc = has_crc ? payload[0] | payload[1] << 8 : 0;
    if (!has_crc || transfer_crc(signature, payload.subspan(2)) != crc) {
      ++counters_.malformed;
      return {};
    }
    payload = payload.subspan(2);
  }
  ++counters_.received;
  return Transfer{session.header, payload};
}

}  // namespace gannet::hal::dronecan

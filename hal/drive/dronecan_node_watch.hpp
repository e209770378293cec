// NodeWatch: whether the nodes that we need are there and well, from their heartbeats, and who
// they are, from GetNodeInfo. Pure: time is an argument. Memory is taken at creation; RT safe.
#pragma once

#include <span>
#include <vector>

#include "hal/drive/dronecan_messages.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal::dronecan {

struct WatchedNode {
  std::uint8_t id = 0;
  bool was_heard = false;
  TimePoint last_heard = {};
  NodeStatus status;
  std::uint32_t restarts = 0;  // its uptime went back
  bool has_tripped = false;    // it did so while enabled
  bool has_info = false;
  NodeInfo info;
};

class NodeWatch {
 public:
  // ids: each node once.
  NodeWatch(std::span<const std::uint8_t> ids, Duration timeout);

  // Nodes that we do not watch are ignored.
  void hear(std::uint8_t source, const NodeStatus& status, TimePoint time);
  void hear(std::uint8_t source, const NodeInfo& info);

  // Whether the motors are enabled. A node that restarts while they are is faulty until they are
  // not: it lost what it was told, and must not go on by itself.
  void set_enabled(bool enabled);

  // It is heard, and does not say that it goes offline.
  bool is_alive(std::uint8_t id, TimePoint now) const;
  // It says that it is broken, or does something else than its work (maintenance, an update), or
  // it has tripped.
  bool is_faulty(std::uint8_t id) const;
  bool has_tripped(std::uint8_t id) const;
  // The vendor's status of a faulty node, kNoVendorStatus where it gives none, kRestarted of one
  // that has tripped; 0 of a good one.
  std::uint16_t fault_code(std::uint8_t id) const;
  static constexpr std::uint16_t kNoVendorStatus = 0xFFFF, kRestarted = 0xFFFE;

  // The next node that shall be asked for its info, 0: none now. An unanswered one is asked again
  // after a second, three times; then every ten seconds.
  std::uint8_t next_to_ask(TimePoint now);

  std::span<const WatchedNode> nodes() const { return nodes_; }

 private:
  struct Asking {
    TimePoint next = {};
    int times = 0;
  };
  const WatchedNode* find(std::uint8_t id) const;

  std::vector<WatchedNode> nodes_;
  std::vector<Asking> asking_;
  Duration timeout_;
  bool is_enabled_ = false;
};

}  // namespace gannet::hal::dronecan

#include "hal/drive/dronecan_node_watch.hpp"

namespace gannet::hal::dronecan {
namespace {
constexpr Duration kAskAgain = std::chrono::seconds(1), kAskSeldom = std::chrono::seconds(10);
constexpr int kQuickTries = 3;
}  // namespace

NodeWatch::NodeWatch(std::span<const std::uint8_t> ids, Duration timeout)
    : nodes_(ids.size()), asking_(ids.size()), timeout_(timeout) {
  for (std::size_t i = 0; i < ids.size(); ++i) nodes_[i].id = ids[i];
}

const WatchedNode* NodeWatch::find(std::uint8_t id) const {
  for (const WatchedNode& node : nodes_) {
    if (node.id == id) return &node;
  }
  return nullptr;
}

void NodeWatch::hear(std::uint8_t source, const NodeStatus& status, TimePoint time) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    WatchedNode& node = nodes_[i];
    if (node.id != source) continue;
    if (node.was_heard && status.uptime_s < node.status.uptime_s) {
      ++node.restarts;
      node.has_tripped = node.has_tripped || is_enabled_;
      node.has_info = false;  // it may be another device, or other software
      asking_[i] = {};
    }
    node.was_heard = true;
    node.last_heard = time;
    node.status = status;
  }
}

void NodeWatch::hear(std::uint8_t source, const NodeInfo& info) {
  for (WatchedNode& node : nodes_) {
    if (node.id != source) continue;
    node.info = info;
    node.has_info = true;
  }
}

void NodeWatch::set_enabled(bool enabled) {
  is_enabled_ = enabled;
  if (enabled) return;
  for (WatchedNode& node : nodes_) node.has_tripped = false;
}

bool NodeWatch::is_alive(std::uint8_t id, TimePoint now) const {
  const WatchedNode* node = find(id);
  return node != nullptr && node->was_heard && now - node->last_heard <= timeout_ &&
         node->status.mode != NodeStatus::kOffline;
}

bool NodeWatch::is_faulty(std::uint8_t id) const {
  const WatchedNode* node = find(id);
  if (node == nullptr || !node->was_heard) return false;
  // Initialization is no fault: the node reports no feedback yet and is waited for.
  const bool is_working = node->status.mode == NodeStatus::kOperational ||
                          node->status.mode == NodeStatus::kInitialization;
  return node->status.health >= NodeStatus::kError || !is_working || node->has_tripped;
}

bool NodeWatch::has_tripped(std::uint8_t id) const {
  const WatchedNode* node = find(id);
  return node != nullptr && node->has_tripped;
}

std::uint16_t NodeWatch::fault_code(std::uint8_t id) const {
  if (!is_faulty(id)) return 0;
  if (has_tripped(id)) return kRestarted;
  const std::uint16_t code = find(id)->status.vendor_status;
  return code != 0 ? code : kNoVendorStatus;
}

std::uint8_t NodeWatch::next_to_ask(TimePoint now) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Asking& asking = asking_[i];
    const bool is_due = asking.times == 0 || now >= asking.next;
    if (nodes_[i].has_info || !is_alive(nodes_[i].id, now) || !is_due) continue;
    ++asking.times;
    asking.next = now + (asking.times < kQuickTries ? kAskAgain : kAskSeldom);
    return nodes_[i].id;
  }
  return 0;
}

}  // namespace gannet::hal::dronecan

// EventStore: the newest events with running numbers, so that a client can ask for those since the
// last it saw. Control thread.
#pragma once

#include <cstdint>
#include <deque>

#include "platform/base/event.hpp"

namespace gannet::telemetry {

class EventStore {
 public:
  explicit EventStore(std::size_t capacity = 1000) : capacity_(capacity) {}

  struct Entry {
    std::uint64_t number = 0;  // from 1
    Event event;
  };

  const Entry& add(const Event& event) {
    if (entries_.size() == capacity_) entries_.pop_front();
    return entries_.emplace_back(Entry{++count_, event});
  }
  const std::deque<Entry>& entries() const { return entries_; }  // oldest first
  std::uint64_t count() const { return count_; }                 // ever added

 private:
  std::size_t capacity_;
  std::deque<Entry> entries_;
  std::uint64_t count_ = 0;
};

}  // namespace gannet::telemetry

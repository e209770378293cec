// SpscRing: a queue of fixed capacity from one thread to one other; wait-free both ways. Elements
// may be move-only (a StereoFrame with its leases); a popped slot holds a moved-from element.
// When the ring is full push refuses and leaves the value with the caller, who decides.
// Created at start-up; push belongs to one thread, pop to one other; size from any. RT safe.
#pragma once

#include <atomic>
#include <bit>
#include <cassert>
#include <cstdint>
#include <memory>
#include <utility>

namespace gannet {

template <class T>
class SpscRing {
 public:
  // The capacity is rounded up to a power of two.
  explicit SpscRing(int capacity)
      : mask_(std::bit_ceil(static_cast<std::uint64_t>(capacity)) - 1),
        slots_(std::make_unique<T[]>(mask_ + 1)) {
    assert(capacity >= 1);
  }
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // False: full, value untouched.
  bool push(T&& value) {
    // Relaxed: only this thread writes tail_.
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - seen_head_ > mask_) {
      // Pairs with the release in pop: the reader has moved out of the slot before we refill it.
      seen_head_ = head_.load(std::memory_order_acquire);
      if (tail - seen_head_ > mask_) return false;
    }
    slots_[tail & mask_] = std::move(value);
    // Pairs with the acquire in pop: the element is whole before the reader sees the index.
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  bool push(const T& value) requires std::is_copy_constructible_v<T> {
    T copy = value;
    return push(std::move(copy));
  }

  // False: empty, out untouched.
  bool pop(T& out) {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);  // only we write head_
    if (head == seen_tail_) {
      seen_tail_ = tail_.load(std::memory_order_acquire);  // pairs with the release in push
      if (head == seen_tail_) return false;
    }
    out = std::move(slots_[head & mask_]);
    head_.store(head + 1, std::memory_order_release);  // pairs with the acquire in push
    return true;
  }

  // A snapshot: either side may have moved on meanwhile. Head is read first, so never negative.
  int size() const {
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    return static_cast<int>(tail_.load(std::memory_order_acquire) - head);
  }
  int capacity() const { return static_cast<int>(mask_ + 1); }

 private:
  static constexpr std::size_t kCacheLine = 64;
  // Each index shares its line only with its thread's own copy of the peer's index, so that the
  // common case touches no line that the other thread writes.
  alignas(kCacheLine) std::atomic<std::uint64_t> tail_{0};
  std::uint64_t seen_head_ = 0;  // writer's
  alignas(kCacheLine) std::atomic<std::uint64_t> head_{0};
  std::uint64_t seen_tail_ = 0;  // reader's
  alignas(kCacheLine) const std::uint64_t mask_;
  const std::unique_ptr<T[]> slots_;
};

}  // namespace gannet

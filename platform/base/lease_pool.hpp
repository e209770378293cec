// LeasePool: up to 64 equal slots that go out hand to hand and come home by one atomic bit.
// The owner (a camera) lends a free slot, fills it, and passes the Lease on; whoever holds it last
// drops it, from any thread, and the slot is free again. One holder at each instant.
//
// The pool outlives its leases. lend() is for the owner's thread alone; a Lease's destructor may
// run on any thread. RT safe.
#pragma once

#include <atomic>
#include <cassert>
#include <cstdint>
#include <utility>

namespace gannet {

class LeasePool;

class Lease {
 public:
  Lease() = default;
  Lease(Lease&& other) noexcept : home_(std::exchange(other.home_, nullptr)), slot_(other.slot_) {}
  Lease& operator=(Lease&& other) noexcept {
    if (this != &other) {
      release();
      home_ = std::exchange(other.home_, nullptr);
      slot_ = other.slot_;
    }
    return *this;
  }
  ~Lease() { release(); }

  bool valid() const { return home_ != nullptr; }
  int slot() const { return slot_; }
  inline void release();

 private:
  friend class LeasePool;
  Lease(LeasePool* home, int slot) : home_(home), slot_(slot) {}
  LeasePool* home_ = nullptr;
  int slot_ = -1;
};

class LeasePool {
 public:
  explicit LeasePool(int slots) : slots_(slots) {
    assert(slots >= 1 && slots <= 64);
    free_.store(slots == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << slots) - 1);
  }
  LeasePool(const LeasePool&) = delete;
  LeasePool& operator=(const LeasePool&) = delete;

  // An invalid lease when all slots are out.
  Lease lend() {
    // Pairs with the release in come_home: what the last holder read is done before we write.
    const std::uint64_t free = free_.load(std::memory_order_acquire);
    if (free == 0) return {};
    const int slot = __builtin_ctzll(free);
    // Only this thread clears bits, so the bit is still set; others may set more meanwhile.
    free_.fetch_and(~(std::uint64_t{1} << slot), std::memory_order_relaxed);
    return Lease(this, slot);
  }

  // This very slot, where the device says which (V4L2, shared memory); invalid when it is out.
  Lease lend_slot(int slot) {
    if (!is_free(slot)) return {};
    free_.fetch_and(~(std::uint64_t{1} << slot), std::memory_order_relaxed);
    return Lease(this, slot);
  }
  // Whether the slot is home. Acquire: what its last holder read is done.
  bool is_free(int slot) const { return (free_.load(std::memory_order_acquire) >> slot & 1) != 0; }

  int slots() const { return slots_; }
  // Acquire: whoever sees all slots home may take the pool down.
  int free_count() const { return __builtin_popcountll(free_.load(std::memory_order_acquire)); }

 private:
  friend class Lease;
  void come_home(int slot) { free_.fetch_or(std::uint64_t{1} << slot, std::memory_order_release); }
  std::atomic<std::uint64_t> free_;
  const int slots_;
};

inline void Lease::release() {
  if (home_ == nullptr) return;
  home_->come_home(slot_);
  home_ = nullptr;
}

}  // namespace gannet

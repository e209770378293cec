// LatestValue: the newest whole value from one writer to one reader: a triple buffer. Neither side
// ever waits; values in between are lost on purpose. Two readers get two of these.
// write/back/publish belong to one thread, fresh/read to one other. RT safe.
#pragma once

#include <atomic>
#include <cstdint>

namespace gannet {

template <class T>
class LatestValue {
 public:
  LatestValue() = default;
  explicit LatestValue(const T& first) : slots_{{first}, {first}, {first}} {}
  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  // The writer's own slot, to be filled in place and then published. What it holds before is
  // some older value.
  T& back() { return slots_[back_].value; }
  void publish() {
    // Release: the value is whole before the reader can take its slot. Acquire: pairs with the
    // reader's exchange, so that its reads of the slot that we get back are over.
    back_ = middle_.exchange(static_cast<std::uint8_t>(back_ | kFresh), std::memory_order_acq_rel) &
            kIndex;
  }
  void write(const T& value) {
    back() = value;
    publish();
  }

  // Is there a value newer than that of the last read()? Relaxed: a hint; read() synchronises.
  bool fresh() const { return (middle_.load(std::memory_order_relaxed) & kFresh) != 0; }

  // The newest value; before the first write a first or default one. The reference stays good and
  // unchanged until the reader's next read().
  const T& read() {
    if (fresh()) {
      // Acquire pairs with publish's release; release with its acquire, see there.
      front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    }
    return slots_[front_].value;
  }

 private:
  static constexpr std::uint8_t kIndex = 3;
  static constexpr std::uint8_t kFresh = 4;
  struct alignas(64) Slot {
    T value{};
  };
  Slot slots_[3];
  alignas(64) std::uint8_t back_ = 0;                // writer's
  alignas(64) std::atomic<std::uint8_t> middle_{1};  // index, and kFresh if not read yet
  alignas(64) std::uint8_t front_ = 2;               // reader's
};

}  // namespace gannet

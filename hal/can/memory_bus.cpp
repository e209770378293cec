#include "hal/can/memory_bus.hpp"

#include <algorithm>
#include <cassert>

namespace gannet::hal {

class MemoryBus final : public CanBus {
 public:
  MemoryBus(MemoryWire& wire, int capacity)
      : wire_(wire), queue_(static_cast<std::size_t>(capacity)) {}

  int send(std::span<const CanFrame> frames, TimePoint now) override {
    if (wire_.is_cut_) {
      counters_.send_refused += frames.size();
      return 0;
    }
    for (const CanFrame& frame : frames) {
      for (const auto& port : wire_.ports_) {
        if (port.get() != this) port->arrive({frame, now});
      }
    }
    counters_.sent += frames.size();
    return static_cast<int>(frames.size());
  }

  int receive(std::span<ReceivedCanFrame> frames, TimePoint) override {
    const std::size_t taken = std::min(frames.size(), filled_);
    for (std::size_t i = 0; i < taken; ++i) {
      frames[i] = queue_[first_];
      first_ = (first_ + 1) % queue_.size();
    }
    filled_ -= taken;
    counters_.received += taken;
    return static_cast<int>(taken);
  }

  BusState state() const override { return wire_.is_cut_ ? BusState::kDown : BusState::kGood; }
  CanCounters counters() const override { return counters_; }

 private:
  void arrive(const ReceivedCanFrame& received) {
    if (filled_ == queue_.size()) {  // as a controller: the newest is lost
      ++counters_.receive_dropped;
      return;
    }
    queue_[(first_ + filled_++) % queue_.size()] = received;
  }

  MemoryWire& wire_;
  std::vector<ReceivedCanFrame> queue_;
  std::size_t first_ = 0, filled_ = 0;
  CanCounters counters_;
};

MemoryWire::MemoryWire(int ports, int frames_per_port) {
  assert(ports >= 1 && frames_per_port >= 1);
  for (int i = 0; i < ports; ++i) {
    ports_.push_back(std::make_unique<MemoryBus>(*this, frames_per_port));
  }
}

MemoryWire::~MemoryWire() = default;

CanBus& MemoryWire::port(int index) const { return *ports_.at(static_cast<std::size_t>(index)); }

namespace {

class LonelyBus final : public CanBus {
 public:
  int send(std::span<const CanFrame> frames, TimePoint now) override {
    return wire_.port(0).send(frames, now);
  }
  int receive(std::span<ReceivedCanFrame> frames, TimePoint now) override {
    return wire_.port(0).receive(frames, now);
  }
  BusState state() const override { return BusState::kGood; }
  CanCounters counters() const override { return wire_.port(0).counters(); }

 private:
  MemoryWire wire_{1};
};

}  // namespace

std::unique_ptr<CanBus> make_lonely_bus() { return std::make_unique<LonelyBus>(); }

}  // namespace gannet::hal

// MemoryWire: a CAN bus inside one thread: what one port sends, every other port receives, in
// order. For tests, and as the kind "memory" for a daemon without motors. The wire owns its ports
// and outlives who uses them. Memory is taken at creation. RT safe after it.
#pragma once

#include <memory>
#include <vector>

#include "hal/can/can_bus.hpp"

namespace gannet::hal {

class MemoryBus;

class MemoryWire {
 public:
  explicit MemoryWire(int ports, int frames_per_port = 256);
  ~MemoryWire();
  MemoryWire(const MemoryWire&) = delete;
  MemoryWire& operator=(const MemoryWire&) = delete;

  int ports() const { return static_cast<int>(ports_.size()); }
  CanBus& port(int index) const;

  // A cut wire: every port is kDown and refuses. For tests of the fault.
  void cut(bool is_cut) { is_cut_ = is_cut; }

 private:
  friend class MemoryBus;
  std::vector<std::unique_ptr<MemoryBus>> ports_;
  bool is_cut_ = false;
};

// A port of a wire that it owns: nobody else is on it.
std::unique_ptr<CanBus> make_lonely_bus();

}  // namespace gannet::hal

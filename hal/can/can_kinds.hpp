// The table of CAN bus kinds. A new kind is one file pair and one line in can_kinds.cpp.
// Start-up only.
#pragma once

#include <memory>
#include <vector>

#include "hal/can/can_bus.hpp"
#include "hal/can/can_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

// wanted: the frames that somebody will read; empty: all. most_waiting: how many frames may wait
// for a bus that takes none, so that old commands do not add up; at least the most that one servo
// cycle sends (DriveGroup::max_frames). The caller owns the bus.
Result<std::unique_ptr<CanBus>> make_can_bus(const CanConfig& config,
                                             const std::vector<CanFilter>& wanted, int most_waiting,
                                             TimePoint now);

}  // namespace gannet::hal

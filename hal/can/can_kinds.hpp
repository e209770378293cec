// The table of CAN bus kinds. A new kind is one file pair and one line in can_kinds.cpp.
// Start-up only.
#pragma once

#include <memory>
#include <vector>

#include "hal/can/can_bus.hpp"
#include "hal/can/can_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

// wanted: the frames that somebody will read; empty: all. The caller owns the bus.
Result<std::unique_ptr<CanBus>> make_can_bus(const CanConfig& config,
                                             const std::vector<CanFilter>& wanted, TimePoint now);

}  // namespace gannet::hal

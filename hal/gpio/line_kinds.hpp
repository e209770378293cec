// The table of digital line kinds. A new kind is one file pair and one line in line_kinds.cpp.
// What comes out speaks of active and inactive: with active_low, kHigh is the low level.
// An output is inactive before its first write, if its kind can say so, and is left inactive.
// Kind "none" is a line that is not fitted: as input always inactive (kLow), as output accepted
// and without effect. Start-up only.
#pragma once

#include <memory>

#include "hal/gpio/digital_line.hpp"
#include "hal/gpio/line_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

// The caller owns the line.
Result<std::unique_ptr<DigitalInput>> make_input(const LineConfig& config);
Result<std::unique_ptr<DigitalOutput>> make_output(const LineConfig& config);

}  // namespace gannet::hal

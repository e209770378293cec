// Permit: how much motion the supervisor allows in this cycle. It crosses from safety to servo and
// vehicle, which do not know each other. A value; RT safe.
#pragma once

#include <cstdint>

namespace gannet {

enum class Permit : std::uint8_t {
  kNone,      // motors commanded to stop, whatever anybody wishes
  kHoldOnly,  // velocity zero, level; nothing is followed
  kFull,
};

}  // namespace gannet

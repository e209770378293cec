// CameraFaults: what is wrong with the simulated cameras at present, and what follows for a pair's
// stamps and times. Pictures that stand still are the cameras' business (cameras.hpp). Pure; a
// value; world's thread alone.
#pragma once

#include <array>
#include <optional>

#include "src/world/frame_sink.hpp"

namespace gannet::world {

struct CameraFaults {
  bool frozen = false;                      // the last picture comes again and again, stamp and all
  bool is_short = false;                    // images end too early
  std::optional<TimePoint> backward_since;  // from then on stamps run backwards
  std::array<Duration, 2> late = {};        // comes so much later, by Side; its stamp is true
  std::array<Duration, 2> skew = {};        // is exposed so much later, and says so

  // stamp: of the exposure that the picture shows; exposed: of the one that was due.
  PairTimes times(TimePoint stamp, TimePoint exposed, Duration latency) const;
};

}  // namespace gannet::world

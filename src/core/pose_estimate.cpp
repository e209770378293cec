#include "src/core/pose_estimate.hpp"

namespace gannet {

const char* to_string(TrackState state) {
  switch (state) {
    case TrackState::kSearching:
      return "searching";
    case TrackState::kLocked:
      return "locked";
    case TrackState::kCoasting:
      return "coasting";
    case TrackState::kLost:
      return "lost";
  }
  return "?";
}

const char* to_string(TrackReason reason) {
  switch (reason) {
    case TrackReason::kNone:
      return "none";
    case TrackReason::kNoTarget:
      return "no_target";
    case TrackReason::kNotFound:
      return "not_found";
    case TrackReason::kLowFitness:
      return "low_fitness";
    case TrackReason::kJumped:
      return "jumped";
    case TrackReason::kOutOfView:
      return "out_of_view";
    case TrackReason::kNoFrames:
      return "no_frames";
  }
  return "?";
}

}  // namespace gannet

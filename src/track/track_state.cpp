#include "src/track/track_state.hpp"

namespace gannet::track {

void TrackStateMachine::restart() {
  state_ = TrackState::kSearching;
  finds_ = 0;
}

TrackState TrackStateMachine::step(bool found, TimePoint time) {
  finds_ = found ? finds_ + 1 : 0;
  if (found) last_seen_ = time;
  switch (state_) {
    case TrackState::kSearching:
    case TrackState::kLost:
      if (finds_ >= lock_frames_) state_ = TrackState::kLocked;
      break;
    case TrackState::kLocked:
    case TrackState::kCoasting:
      if (found) {
        state_ = TrackState::kLocked;
      } else {
        state_ = time - last_seen_ > coast_ ? TrackState::kLost : TrackState::kCoasting;
      }
      break;
  }
  return state_;
}

}  // namespace gannet::track

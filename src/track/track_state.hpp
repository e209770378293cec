// TrackStateMachine: searching → locked → coasting → lost, from finds and times alone.
//
//   searching ──found ×n──▶ locked ◀──found── coasting
//                             │ unseen            ▲  │ unseen longer than coast
//                             └───────────────────┘  ▼
//                                    lost ──found ×n──▶ locked
//
// Pure; RT safe.
#pragma once

#include "platform/base/time.hpp"
#include "src/core/pose_estimate.hpp"

namespace gannet::track {

class TrackStateMachine {
 public:
  TrackStateMachine(int lock_frames, Duration coast) : lock_frames_(lock_frames), coast_(coast) {}

  void restart();
  // One frame's outcome, or a look at the clock without one (found false).
  TrackState step(bool found, TimePoint time);
  TrackState state() const { return state_; }

 private:
  const int lock_frames_;
  const Duration coast_;
  TrackState state_ = TrackState::kSearching;
  int finds_ = 0;
  TimePoint last_seen_ = {};
};

}  // namespace gannet::track

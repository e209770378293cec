// False locks: footage of other creatures without the one that is sought, through the tracker as
// the daemon has it, counting how often it locks; and footage with it, counting the frames in which
// it is locked on the right pose. Report only; the answer does not depend on the Parallel.
#pragma once

#include <functional>

#include "tests/report/studio.hpp"

namespace gannet::robustness {

inline constexpr int kClipFrames = 120;  // 4 s at 30 Hz
inline constexpr int kSettleFrames = 6;  // of a clip with the target, before detection counts

struct Campaign {
  int clips = 30;  // without the target
  int clips_with = 10;
  std::uint64_t seed = 1;
};

struct LockCount {
  long frames = 0, locked = 0;         // without the target
  int false_locks = 0;                 // times that it went to locked; two in one clip are two
  long frames_with = 0, detected = 0;  // with it
  long frames_asked = 0, detected_asked = 0;  // of them: all of it in both views and the volume
  int missed_clips = 0;                       // with it, never locked on it
};

// done(n): n clips are over; on the caller's thread.
Result<LockCount> count_locks(const Campaign& campaign, const Cast& cast, Parallel& parallel,
                              const std::function<void(long)>& done);
std::string lock_summary(const LockCount& count);

}  // namespace gannet::robustness

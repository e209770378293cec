// ReplayCamera: recorded pairs from files, each at its time after the first call of capture().
// Live, a normal thread of its own reads and decodes ahead into the slots, so that capture() is RT
// safe; a pair that it cannot have ready in time is skipped and counted. Stepped, capture() itself
// reads what is due, exactly and in order (not RT safe, and no need).
// A broken pair is told once in the log and by kBroken; numbers show gaps where pairs are missing.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/image_decoder.hpp"
#include "hal/camera/replay_source.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "platform/base/ring.hpp"
#include "platform/linux/futex.hpp"
#include "platform/linux/thread.hpp"

namespace gannet::hal {

class ReplayCamera final : public StereoCamera {
 public:
  static Result<std::unique_ptr<StereoCamera>> create(const ReplayCameraConfig& config,
                                                      DecodeImage decode, Pace pace);
  ~ReplayCamera() override;

  int width() const override { return source_.width(); }
  int height() const override { return source_.height(); }
  Result<void> start() override;
  CaptureStatus capture(TimePoint now, Duration timeout, StereoFrame& frame) override;
  CaptureCounters counters() const override;

 private:
  // A pair in its slot, or the news that it is broken.
  struct Loaded {
    Lease lease;
    std::uint64_t index = 0;
    bool broken = false;
  };

  ReplayCamera(ReplaySource source, int slots, Pace pace);
  CaptureStatus capture_stepped(TimePoint now, StereoFrame& frame);
  CaptureStatus capture_live(TimePoint now, TimePoint deadline, StereoFrame& frame);
  CaptureStatus deliver(Loaded loaded, StereoFrame& frame);
  TimePoint due(std::uint64_t index) const;
  Loaded load(Lease lease, std::uint64_t index);
  void decode_ahead();
  Lease wait_for_slot();
  bool is_too_late(std::uint64_t index) const;

  const ReplaySource source_;
  const Pace pace_;
  std::vector<ReplayPair> pairs_;  // one a slot
  LeasePool pool_;

  // Capture thread
  Loaded pending_;          // taken from the ring, not yet due; valid lease: there is one
  std::uint64_t next_ = 0;  // stepped: the next index
  CaptureCounters counters_;

  // Between the threads
  std::atomic<std::int64_t> origin_ns_{-1};  // when the first pair is due; −1: not known yet
  SpscRing<Loaded> loaded_;                  // decoder → capture
  linux_os::FutexWord news_{0};              // the decoder has pushed, or has ended
  std::atomic<bool> ended_{false};           // nothing will be pushed any more
  std::atomic<std::uint64_t> skipped_{0};    // by the decoder
  linux_os::FutexWord stop_{0};
  linux_os::Thread decoder_;
};

}  // namespace gannet::hal

// V4l2Device: one V4L2 device that streams through mapped driver buffers, without a copy: the
// buffer is the slot of the lease pool, and when its lease has come home the next call of take()
// gives it back to the driver. Buffers that somebody still looks at are never given back.
// Opening and closing: a normal thread, with all leases home. The rest: capture thread; RT safe.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "hal/camera/v4l2_format.hpp"
#include "hal/camera/v4l2_judge.hpp"
#include "platform/base/lease_pool.hpp"

namespace gannet::hal {

// An image as the driver left it; the bytes are valid while the lease is held.
struct V4l2Image {
  Lease lease;
  std::span<const std::uint8_t> bytes;
  TimePoint stamp;           // the driver's
  TimePoint exposure;        // its middle, by the stamp's source; never in the future
  std::uint64_t number = 0;  // counts from 1, with those that were lost
};

enum class V4l2Taken : std::uint8_t {
  kImage,
  kNothing,
  kRefused,  // counted, its buffer given back
  kNoSlot,   // nearly all buffers are out: dropped and counted
  kGone,     // unplugged, or the stream has failed: to be opened anew
};

class V4l2Device {
 public:
  // Opens, agrees on everything, starts the stream. may_pass tells of an error that it may go away
  // by itself: no such file yet, busy, no writer behind a loop-back device.
  static Result<std::unique_ptr<V4l2Device>> open(V4l2System& system, const std::string& path,
                                                  const V4l2StreamConfig& config, bool& may_pass);
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;
  ~V4l2Device();

  const V4l2Format& format() const { return format_; }
  int fd() const { return fd_; }
  int buffers() const { return count_; }
  // Whether the driver says that its stamps are of CLOCK_MONOTONIC.
  bool names_its_clock() const { return names_its_clock_; }

  // Does not wait. The first image of the stream is passed over.
  V4l2Taken take(TimePoint now, CaptureCounters& counters, V4l2Image& image);
  bool all_home() const { return pool_->free_count() == count_; }

 private:
  struct Buffer {
    std::uint8_t* memory = nullptr;
    std::size_t bytes = 0;
    bool queued = false;
  };
  static constexpr int kMostBuffers = 32;

  V4l2Device(V4l2System& system, int fd, const V4l2StreamConfig& config);
  Result<void> set_up(const std::string& path, bool& may_pass);
  Result<void> map_buffers(const std::string& path, bool& may_pass);
  Result<void> map_buffer(const std::string& path, int index);
  bool queue(int index);
  void queue_returned();
  TimePoint middle_of_exposure(std::uint32_t flags, TimePoint stamp, TimePoint now) const;

  V4l2System& system_;
  const int fd_;
  const V4l2StreamConfig config_;
  V4l2Format format_;
  std::array<Buffer, kMostBuffers> buffers_;
  int count_ = 0;
  int queued_ = 0;
  bool names_its_clock_ = true;
  std::unique_ptr<LeasePool> pool_;
  V4l2Judge judge_{0, false};
  std::uint64_t number_ = 0;
  bool is_first_ = true;
};

}  // namespace gannet::hal

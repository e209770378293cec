// MjpegDecoder: compressed pairs in, planar YUV pairs out, on a normal thread of its own, because
// the library takes memory and time as it likes. What it cannot take in or finish in time is
// dropped and counted. A pair that is being decoded holds its driver buffers by their leases.
// create and the destructor: start-up only; submit and take: capture thread, RT safe.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <vector>

#include "hal/camera/image_decoder.hpp"
#include "hal/camera/v4l2_device.hpp"
#include "platform/base/ring.hpp"
#include "platform/linux/fd.hpp"
#include "platform/linux/futex.hpp"
#include "platform/linux/thread.hpp"

namespace gannet::hal {

// One device's image, or two that belong together (the second one is empty for one device).
struct V4l2Images {
  std::array<V4l2Image, 2> image;
  TimePoint exposure;
  std::uint64_t number = 0;
};

class MjpegDecoder {
 public:
  struct Setting {
    int images;  // of a pair: 1 or 2
    int width;   // pixels that each must have
    int height;
    int slots;
    Duration limit;  // from submit to decoded
  };
  struct Decoded {
    Lease lease;
    std::array<ImageView, 2> view;  // valid while the lease is held
    TimePoint exposure;
    std::uint64_t number = 0;
    bool broken = false;  // the lease and the number are all that is good
  };

  static Result<std::unique_ptr<MjpegDecoder>> create(const Setting& setting, DecodeImage decode,
                                                      V4l2System& system);
  ~MjpegDecoder();

  // False: it is still busy with two older ones; the pair stays with the caller.
  bool submit(V4l2Images&& images);
  bool take(Decoded& decoded);             // false: nothing is ready
  int fd() const { return ready_.get(); }  // readable when something is ready

  std::uint64_t late() const { return late_.load(std::memory_order_relaxed); }
  std::uint64_t without_slot() const { return without_slot_.load(std::memory_order_relaxed); }

 private:
  struct Job {
    V4l2Images images;
    TimePoint submitted;
  };
  MjpegDecoder(const Setting& setting, DecodeImage decode, V4l2System& system, int ready);
  void decode_loop();
  void work(Job job);
  bool decode_pair(const V4l2Images& images, std::array<Image, 2>& out);
  bool is_late(const Job& job);

  const Setting setting_;
  const DecodeImage decode_;
  V4l2System& system_;
  const linux_os::Fd ready_;  // an eventfd, so that one poll waits for it and the devices

  std::vector<std::array<Image, 2>> slots_;
  LeasePool pool_;  // lent by the decoder
  bool told_ = false;
  SpscRing<Job> jobs_{2};
  SpscRing<Decoded> done_;
  linux_os::FutexWord news_{0};
  std::atomic<bool> stop_{false};
  std::atomic<std::uint64_t> late_{0};
  std::atomic<std::uint64_t> without_slot_{0};
  linux_os::Thread thread_;
};

}  // namespace gannet::hal

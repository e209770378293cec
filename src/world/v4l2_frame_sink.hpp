// V4l2FrameSink: pairs into two V4L2 output devices of v4l2loopback, whose other ends the daemon
// opens as cameras. Each image is handed over at its own moment, by a thread of the sink, with the
// stamp it was given: v4l2loopback passes a writer's stamps on when they come with a queued buffer
// (write() would stamp anew). It never asks for a buffer back, so buffers are taken in turn and
// never dequeued; other drivers' output devices want that and are refused by nothing but their
// behaviour.
// begin_frame and publish: the cameras' drawing thread. hand_over_due: the sink's own thread, or
// a test's where there is none.
#pragma once

#include <array>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hal/camera/v4l2_system.hpp"
#include "platform/base/result.hpp"
#include "src/world/frame_sink.hpp"

namespace gannet::world {

// One output device that streams.
class V4l2Output {
 public:
  // Error: which device, which call, why.
  static Result<V4l2Output> open(const std::string& path, int width, int height, double rate_hz,
                                 hal::V4l2System& system);
  V4l2Output(V4l2Output&& other) noexcept;
  V4l2Output& operator=(V4l2Output&&) = delete;
  ~V4l2Output();

  // bytes: of the image that are said to be used; the whole image is copied. False: refused.
  bool show(std::span<const std::uint8_t> image, std::size_t bytes, TimePoint stamp);

 private:
  V4l2Output(std::string path, int fd, hal::V4l2System& system)
      : path_(std::move(path)), fd_(fd), system_(&system) {}
  Result<void> start(int width, int height, double rate_hz);
  Result<void> map_buffers();
  Error error(const char* call, int result) const;

  struct Mapping {
    void* memory;
    std::size_t bytes;
  };
  std::string path_;
  int fd_ = -1;
  hal::V4l2System* system_;
  std::vector<Mapping> buffers_;
  std::uint32_t next_ = 0;
};

class V4l2FrameSink final : public FrameSink {
 public:
  struct Config {
    std::array<std::string, 2> devices;  // by Side
    int width = 640;
    int height = 480;
    double rate_hz = 30;
    bool has_thread = true;
  };
  static Result<std::unique_ptr<FrameSink>> create(const Config& config,
                                                   hal::V4l2System& system = hal::kernel_v4l2());
  ~V4l2FrameSink() override;

  FrameSinkAbilities abilities() const override {
    return {.short_frames = true, .error_flags = false, .two_stamps = true};
  }
  const hal::ImageLayout& layout() const override { return layout_; }
  std::optional<Images> begin_frame() override;
  void publish(const PairTimes& times) override;

  void hand_over_due(TimePoint now);
  std::uint64_t refused() const { return refused_; }  // images that a device would not take

 private:
  static constexpr int kPairs = 8;  // drawn and not yet handed over
  struct Pair {
    std::array<std::vector<std::uint8_t>, 2> image;
    int waiting = 0;  // images
  };
  struct Handover {
    TimePoint due, stamp;
    int pair;
    Side side;
    bool is_short;
  };
  V4l2FrameSink(V4l2Output left, V4l2Output right, const hal::ImageLayout& layout,
                hal::V4l2System& system);
  void work();

  const hal::ImageLayout layout_;
  hal::V4l2System& system_;
  std::array<V4l2Output, 2> outputs_;  // by Side; handing over alone

  std::mutex mutex_;
  std::condition_variable wake_;
  std::array<Pair, kPairs> pairs_;
  std::deque<Handover> handovers_;  // in the order of due
  int drawing_ = 0;                 // pair
  bool stop_ = false;
  std::uint64_t refused_ = 0;
  std::thread thread_;
};

}  // namespace gannet::world

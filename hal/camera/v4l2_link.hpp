// V4l2Link: a device that comes back. When it is unplugged, its stream fails or no good image came
// for a while, it is closed and opened anew, with growing pauses, until it streams as before.
// That is done by a normal thread: opening takes memory, text and, on USB, a second at times.
// First all images of the lost stream must be home, for they lie in the driver's buffers.
// start and the destructor: start-up only; the rest: capture thread, RT safe.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/camera/v4l2_device.hpp"
#include "platform/linux/futex.hpp"
#include "platform/linux/thread.hpp"

namespace gannet::hal {

class V4l2Link {
 public:
  V4l2Link(V4l2System& system, const std::string& path, const V4l2StreamConfig& config)
      : system_(system), path_(path), config_(config) {}
  ~V4l2Link();

  // Waits for the device, if need be. Error: it did not come, or does not fit.
  Result<void> start();
  const V4l2Format& format() const { return format_; }

  // Does not wait. kGone as long as the device is away.
  V4l2Taken take(TimePoint now, CaptureCounters& counters, V4l2Image& image);
  // To be waited for; −1: away.
  int fd() const { return lost_ ? -1 : device_->fd(); }
  // poll() has told an error: if the next take() finds nothing, the stream is over.
  void note_error() { has_error_ = true; }

 private:
  // Who owns device_: the capture thread, or while kWanted the thread that opens it anew.
  enum State : std::uint32_t { kConnected, kWanted, kReady, kStop };
  using Device = std::unique_ptr<V4l2Device>;

  void introduce(const V4l2Device& device) const;
  bool is_back(TimePoint now);
  void reopen_loop();
  Device reopen();
  void pause(Duration length) const;

  V4l2System& system_;
  const std::string path_;
  const V4l2StreamConfig config_;
  V4l2Format format_;
  Device device_;

  // Capture thread
  bool lost_ = false;
  bool has_error_ = false;
  std::optional<TimePoint> last_good_;

  linux_os::FutexWord state_{kConnected};
  linux_os::Thread opener_;
};

}  // namespace gannet::hal

// SimulatedCamera: the cameras of gannet-world, through shared memory (shared_frames.hpp), without
// a copy. Each pair is given from the time on that the world says, so image latency is simulated.
// When the world ends, dies or falls silent the camera is lost, once its frames are home a normal
// thread opens the memory anew until a world of the same format publishes pairs again.
// Stepped there is no such thread: the daemon ends with its world.
#pragma once

#include <memory>
#include <optional>

#include "hal/camera/camera_config.hpp"
#include "hal/camera/shared_frames.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "platform/linux/thread.hpp"

namespace gannet::hal {

class SimulatedCamera final : public StereoCamera {
 public:
  static Result<std::unique_ptr<StereoCamera>> create(const SimulatedCameraConfig& config,
                                                      Pace pace);
  ~SimulatedCamera() override;

  int width() const override { return format_.width; }
  int height() const override { return format_.height; }
  // Waits for the world. Error: it did not come within the time-out, or what is wrong with it.
  Result<void> start() override;
  CaptureStatus capture(TimePoint now, Duration timeout, StereoFrame& frame) override;
  CaptureCounters counters() const override { return counters_; }

 private:
  // Who owns reader_: the capture thread, or while kWanted the thread that opens it anew.
  enum Link : std::uint32_t { kConnected, kWanted, kReady, kStop };

  SimulatedCamera(const SimulatedCameraConfig& config, Pace pace) : config_(config), pace_(pace) {}
  CaptureStatus look(TimePoint now, StereoFrame& frame);
  CaptureStatus capture_lost(TimePoint now, TimePoint deadline, StereoFrame& frame);
  bool is_silent(TimePoint now);
  void reopen_loop();
  std::unique_ptr<SharedFramesReader> reopen();

  const SimulatedCameraConfig config_;
  const Pace pace_;
  SharedFramesFormat format_ = {.width = 0, .height = 0};
  std::unique_ptr<SharedFramesReader> reader_;

  // Capture thread
  bool lost_ = false;
  std::optional<TimePoint> last_sign_;  // of life
  CaptureCounters counters_;

  linux_os::FutexWord link_{kConnected};
  linux_os::Thread opener_;
};

}  // namespace gannet::hal

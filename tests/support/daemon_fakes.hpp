// Stand-ins for what the daemon's loops talk to, so that a test decides what they say. None takes
// heap after creation.
#pragma once

#include <algorithm>
#include <vector>

#include "hal/camera/image.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "hal/can/can_bus.hpp"
#include "hal/drive/drive.hpp"
#include "hal/gpio/digital_line.hpp"
#include "src/track/target_tracker.hpp"

namespace gannet::test {

// Gives a pair whenever it is asked, unless it is told to say something else.
class FakeCamera final : public hal::StereoCamera {
 public:
  explicit FakeCamera(int slots = 8, int width = 64, int height = 48)
      : image_(width, height, hal::PixelFormat::kYuv422), pool_(slots) {}

  int width() const override { return image_.width(); }
  int height() const override { return image_.height(); }
  Result<void> start() override { return {}; }
  hal::CaptureStatus capture(TimePoint now, Duration, hal::StereoFrame& frame) override {
    if (says != hal::CaptureStatus::kFrame) {
      counters_.broken += says == hal::CaptureStatus::kBroken ? 1 : 0;
      return says;
    }
    Lease lease = pool_.lend();
    if (!lease.valid()) {
      ++counters_.dropped;
      return hal::CaptureStatus::kNoSlot;
    }
    frame.left_lease = std::move(lease);
    frame.left = frame.right = image_.view();
    frame.capture_time = now - latency;
    frame.number = ++counters_.frames;
    return hal::CaptureStatus::kFrame;
  }
  hal::CaptureCounters counters() const override { return counters_; }
  int at_home() const { return pool_.free_count(); }

  hal::CaptureStatus says = hal::CaptureStatus::kFrame;
  Duration latency = std::chrono::milliseconds(40);

 private:
  hal::Image image_;
  LeasePool pool_;
  hal::CaptureCounters counters_;
};

// Finds the chosen target at once where it is told that it is.
class FakeTracker final : public track::TargetTracker {
 public:
  bool choose_model(int index, std::uint32_t id) override {
    if (index < 0 || index >= models) return false;
    choose(id, index);
    return true;
  }
  bool choose_rectangle(const vision::Rectangle& r, std::uint32_t id) override {
    if (r.width < 8) return false;
    choose(id, -1);
    return true;
  }
  void choose_none() override { chosen = {}; }
  PoseEstimate process(const hal::ImageView&, const hal::ImageView&, TimePoint capture_time,
                       std::uint64_t frame_number, const track::Budget& budget,
                       Parallel&) override {
    ++frames;
    could_stop = budget.stop != nullptr;
    stopped = could_stop && budget.stop(budget.context);
    PoseEstimate estimate = chosen;
    estimate.capture_time = capture_time;
    estimate.frame_number = frame_number;
    estimate.left_from_target.translation = {0, 0, 0.6};
    estimate.covariance = Matrix6d::Identity() * 1e-6;
    return estimate;
  }
  PoseEstimate no_frame(TimePoint) override {
    ++silences;
    PoseEstimate estimate = chosen;
    estimate.found = false;
    estimate.state = TrackState::kLost;
    estimate.reason = TrackReason::kNoFrames;
    return estimate;
  }

  void choose(std::uint32_t id, int model) {
    chosen = {};
    chosen.target_id = id;
    chosen.model = model;
    chosen.found = true;
    chosen.state = TrackState::kLocked;
    chosen.reason = TrackReason::kNone;
  }

  int models = 2;
  PoseEstimate chosen;
  int frames = 0;
  int silences = 0;
  bool could_stop = false;
  bool stopped = false;
};

class FakeBus final : public hal::CanBus {
 public:
  int send(std::span<const hal::CanFrame> frames, TimePoint) override {
    if (says == hal::BusState::kDown) return 0;
    counters_.sent += frames.size();
    return static_cast<int>(frames.size());
  }
  int receive(std::span<hal::ReceivedCanFrame>, TimePoint) override { return 0; }
  hal::BusState state() const override { return says; }
  hal::CanCounters counters() const override { return counters_; }

  hal::BusState says = hal::BusState::kGood;

 private:
  hal::CanCounters counters_;
};

// Remembers the newest command.
class FakeDrives final : public hal::DriveGroup {
 public:
  explicit FakeDrives(int motors) : last(static_cast<std::size_t>(motors)) {}
  int size() const override { return static_cast<int>(last.size()); }
  void receive(const hal::CanFrame&, TimePoint) override {}
  int send(std::span<const hal::DriveSetpoint> setpoints, bool enable, TimePoint,
           std::span<hal::CanFrame> out) override {
    std::copy(setpoints.begin(), setpoints.end(), last.begin());
    enabled = enable;
    out[0] = {};
    return 1;
  }
  int max_frames() const override { return 1; }
  std::span<const hal::DriveFeedback> feedback() const override { return felt; }
  hal::DriveGroupHealth health(TimePoint) const override { return says; }
  std::uint64_t malformed() const override { return 0; }
  void reset_faults(TimePoint) override { ++resets; }

  double largest() const {
    double most = 0;
    for (const auto& setpoint : last) most = std::max(most, std::abs(setpoint.value));
    return most;
  }

  hal::DriveGroupHealth says = {.all_alive = true};
  std::vector<hal::DriveSetpoint> last;
  std::vector<hal::DriveFeedback> felt;
  bool enabled = false;
  int resets = 0;
};

class FakeInput final : public hal::DigitalInput {
 public:
  Reading read(TimePoint) override { return says; }
  Reading says = {.level = hal::Level::kLow};
};

class FakeOutput final : public hal::DigitalOutput {
 public:
  bool write(bool high, TimePoint) override {
    is_high = high;
    return true;
  }
  bool is_high = false;
};

}  // namespace gannet::test

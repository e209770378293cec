// Proofs of the real-time rules for the daemon's three loops, with their real parts, 10,000 cycles
// of each: no heap; no page fault after warm-up. The times between are the rings' and the kernel's.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "hal/can/memory_bus.hpp"
#include "hal/drive/drive_kinds.hpp"
#include "platform/base/random.hpp"
#include "platform/linux/clock.hpp"
#include "platform/linux/periodic.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/daemon/capture_loop.hpp"
#include "src/daemon/reports.hpp"
#include "src/daemon/servo_loop.hpp"
#include "src/daemon/vision_loop.hpp"
#include "src/track/track_config.hpp"
#include "tests/rt/rt_trap.hpp"
#include "tests/rt/rt_usage.hpp"
#include "tests/support/daemon_fakes.hpp"

namespace gannet::daemon {
namespace {

using std::chrono::milliseconds;

constexpr int kCycles = 10000;
constexpr int kWarmUp = 200;

// Runs the cycle and expects neither heap nor page faults of it.
template <class Cycle>
void prove(Cycle cycle, int cycles = kCycles) {
  for (int i = 0; i < kWarmUp; ++i) cycle(i);
  const int trapped = test::trapped_calls();
  const test::RtUsage before = test::RtUsage::now();
  for (int i = 0; i < cycles; ++i) {
    const test::RtSection section;
    cycle(kWarmUp + i);
  }
  const test::RtUsage used = test::RtUsage::now().since(before);
  EXPECT_EQ(test::trapped_calls() - trapped, 0);
  if (test::trap_works()) {
    EXPECT_EQ(used.page_faults, 0);
  }
}

StereoRig rig(int width, int height) {
  StereoRig rig;
  for (Intrinsics* camera : {&rig.left, &rig.right}) {
    camera->width = width;
    camera->height = height;
    camera->fx = camera->fy = width;
    camera->cx = (width - 1) / 2.0;
    camera->cy = (height - 1) / 2.0;
  }
  rig.right_from_left.translation = {-0.12, 0, 0};
  rig.hand_from_left.translation = {-0.06, 0, 0};
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  rig.body_from_hand = Transform<Body, Hand>{Eigen::Quaterniond(axes), {0.2, 0, 0}};
  return rig;
}

TEST(RtDaemon, the_capture_loop) {
  auto camera = std::make_unique<test::FakeCamera>();
  FrameLine line(4);
  auto report = std::make_unique<LatestValue<CaptureReport>>();
  EventPort events;
  SharedFacts facts;
  auto sut = std::make_unique<CaptureLoop>(
      CaptureLoop::Links{camera.get(), &line, report.get(), &events, &facts}, Duration{});
  prove([&](int i) {
    sut->step(time_from_ns(std::int64_t{i} * 33'000'000), {});
    TakenFrame taken;
    if (i % 3 != 0) line.pop(taken);  // vision is sometimes late
    camera->says = i % 50 == 0 ? hal::CaptureStatus::kLost : hal::CaptureStatus::kFrame;
  });
  EXPECT_EQ(facts.capture_cycles, static_cast<std::uint64_t>(kCycles + kWarmUp));
  EXPECT_GT(report->read().not_taken, 0u);
}

// A wall of random texture at 0.8 m, looked at through a rectangle; sometimes it is hidden.
class Wall {
 public:
  static constexpr int kWidth = 96, kHeight = 72;
  Wall() {
    Random random(3);
    constexpr int kShift = 14;  // f·b/z = 96 · 0.12 / 0.8 = 14.4 pixels
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        left_.row(0, y)[x] = static_cast<std::uint8_t>(random.below(256));
        hidden_.row(0, y)[x] = 90;
      }
      for (int x = 0; x + kShift < kWidth; ++x) right_.row(0, y)[x] = left_.row(0, y)[x + kShift];
    }
    for (hal::Image* image : {&left_, &right_, &hidden_}) {
      for (int p = 1; p < 3; ++p) {
        for (int y = 0; y < kHeight; ++y) {
          for (int x = 0; x < kWidth / 2; ++x) image->row(p, y)[x] = 128;
        }
      }
    }
  }
  TakenFrame frame(int i, bool hidden) const {
    TakenFrame taken;
    taken.frame.left = hidden ? hidden_.view() : left_.view();
    taken.frame.right = hidden ? hidden_.view() : right_.view();
    taken.frame.capture_time = time_from_ns(std::int64_t{i} * 33'000'000);
    taken.frame.number = static_cast<std::uint64_t>(i) + 1;
    return taken;
  }

 private:
  hal::Image left_{kWidth, kHeight, hal::PixelFormat::kYuv422};
  hal::Image right_ = left_, hidden_ = left_;
};

// Counts how often work is handed over.
class CountingPool final : public Parallel {
 public:
  explicit CountingPool(std::vector<linux_os::ThreadConfig> helpers)
      : pool_(std::move(*linux_os::WorkerPool::create("rt-worker", helpers))) {}
  int workers() const override { return pool_->workers(); }
  void run(int n, void (*work)(void*, int, int), void* context) override {
    ++hand_overs;
    pool_->run(n, work, context);
  }
  long hand_overs = 0;

 private:
  std::unique_ptr<linux_os::WorkerPool> pool_;
};

class Vision {
 public:
  explicit Vision(std::vector<linux_os::ThreadConfig> helpers) : pool(std::move(helpers)) {
    track::TrackConfig config;
    config.evaluations = 60;
    config.evaluations_tracking = 20;
    config.z_min_m = 0.6;
    config.z_max_m = 1.0;
    tracker_ =
        std::move(*track::TargetTracker::create(config, rig(Wall::kWidth, Wall::kHeight), {}));
    loop_ = std::make_unique<VisionLoop>(
        VisionLoop::Links{tracker_.get(), &pool, &frames_, nullptr, &choices_, &targets_, &report_,
                          &events_, &facts_},
        true, milliseconds(100));
  }
  // A new choice now and then; the wall is hidden for a while before it.
  void step(int i) {
    if (i % 500 == 0) {
      choices_.push({TargetChoice::Kind::kRectangle,
                     -1,
                     {40, 24, 24, 24},
                     static_cast<std::uint32_t>(i + 1)});
    }
    frames_.push(wall_.frame(i, i % 500 > 450));
    loop_->step(time_from_ns(std::int64_t{i} * 33'000'000));
    SeenTarget seen;
    while (targets_.pop(seen)) found += seen.estimate.found ? 1 : 0;
    Event event;
    while (events_.take(event)) {
    }
  }
  CountingPool pool;
  int found = 0;

 private:
  Wall wall_;
  std::unique_ptr<track::TargetTracker> tracker_;
  FrameLine frames_{4};
  SpscRing<TargetChoice> choices_{4};
  SpscRing<SeenTarget> targets_{64};
  LatestValue<VisionReport> report_;
  EventPort events_;
  SharedFacts facts_;
  std::unique_ptr<VisionLoop> loop_;
};

TEST(RtDaemon, the_vision_loop_with_the_real_tracker) {
  auto sut = std::make_unique<Vision>(std::vector<linux_os::ThreadConfig>{});
  prove([&](int i) { sut->step(i); });
  EXPECT_GT(sut->found, kCycles / 2);
}

TEST(RtDaemon, the_vision_loop_sleeps_at_most_once_for_each_hand_over) {
  constexpr int kFew = 500;
  auto sut = std::make_unique<Vision>(std::vector<linux_os::ThreadConfig>{{}});
  const test::RtUsage before = test::RtUsage::now();
  prove([&](int i) { sut->step(i); }, kFew);
  const test::RtUsage used = test::RtUsage::now().since(before);
  EXPECT_GT(sut->pool.hand_overs, kFew);
  EXPECT_LE(used.voluntary_switches, kFew + kWarmUp + sut->pool.hand_overs);
}

class Servo {
 public:
  // real_drives: the DroneCAN codec, whose ESCs are silent here, so that nothing can be armed;
  // else drives that are always alive.
  explicit Servo(bool real_drives) {
    vehicle::VehicleConfig config;
    config.kind = "rov";
    vehicle_ = std::move(*vehicle::create_vehicle(config));
    law_ = std::move(*servo::create_servo_law({}, rig(640, 480)));
    hal::DriveConfig drives;
    for (int i = 0; i < 6; ++i) {
      hal::MotorConfig motor;
      motor.index = i;
      motor.node_id = 20 + i;
      drives.motors.push_back(motor);
    }
    if (real_drives) {
      drives_ = std::move(*hal::make_drive_group(drives));
    } else {
      drives_ = std::make_unique<test::FakeDrives>(6);
    }
    facts_.capture_cycles = facts_.vision_cycles = 1;
    loop_ = std::make_unique<ServoLoop>(
        ServoLoop::Links{vehicle_.get(), law_.get(), &wire_.port(0), drives_.get(), &estop_,
                         &light_, &targets_, &commands_, &params_, &report_, &events_, &facts_},
        rig(640, 480), safety::SafetyConfig{}, track::FilterConfig{}, servo::ServoParams{},
        milliseconds(5));
  }
  // Everything that can happen, now and then: targets, requests, hand, goals, the e-stop.
  void step(int i, TimePoint now) {
    facts_.last_frame_ns = to_ns(now);
    if (i % 7 == 0) see(i, now);
    ServoCommand command;
    command.number = static_cast<std::uint64_t>(i);
    command.by_hand = i % 100 == 50;
    command.request = i % 1000 == 0   ? safety::Request::kReset
                      : i % 1000 == 1 ? safety::Request::kArm
                                      : safety::Request::kNone;
    if (command.by_hand || command.request != safety::Request::kNone) commands_.push(command);
    if (i % 300 == 0) params_.write(servo::ServoParams{});
    // Pressed for a cycle, and released for long enough before the reset.
    estop_.says.level = i % 1000 == 900 ? hal::Level::kHigh : hal::Level::kLow;
    loop_->step(now);
    Event event;
    while (events_.take(event)) {
    }
    hal::ReceivedCanFrame sent[64];
    while (wire_.port(1).receive(sent, now) > 0) {
    }
  }
  const ServoReport& report() { return report_.read(); }
  int frames_seen() const { return static_cast<int>(wire_.port(1).counters().received); }

 private:
  void see(int i, TimePoint now) {
    SeenTarget seen;
    seen.estimate.capture_time = now - milliseconds(30);
    seen.estimate.frame_number = static_cast<std::uint64_t>(i);
    seen.estimate.target_id = 1;
    seen.estimate.found = true;
    seen.estimate.state = TrackState::kLocked;
    seen.estimate.reason = TrackReason::kNone;
    seen.estimate.left_from_target.translation = {0.001 * (i % 40), 0, 0.6};
    seen.estimate.covariance = Matrix6d::Identity() * 1e-5;
    targets_.push(seen);
  }
  hal::MemoryWire wire_{2};
  test::FakeInput estop_;
  test::FakeOutput light_;
  std::unique_ptr<vehicle::Vehicle> vehicle_;
  std::unique_ptr<servo::ServoLaw> law_;
  std::unique_ptr<hal::DriveGroup> drives_;
  SpscRing<SeenTarget> targets_{64};
  SpscRing<ServoCommand> commands_{16};
  LatestValue<servo::ServoParams> params_;
  LatestValue<ServoReport> report_;
  EventPort events_;
  SharedFacts facts_;
  std::unique_ptr<ServoLoop> loop_;
};

TEST(RtDaemon, the_servo_loop_while_it_steers) {
  auto sut = std::make_unique<Servo>(false);
  const TimePoint start = time_from_ns(100'000'000'000);
  int full = 0;
  prove([&](int i) {
    sut->step(i, start + i * milliseconds(5));
    full += sut->report().outputs.permit == Permit::kFull ? 1 : 0;
  });
  EXPECT_EQ(sut->report().loop.cycles, static_cast<std::uint64_t>(kCycles + kWarmUp));
  EXPECT_GT(full, kCycles / 2);
}

TEST(RtDaemon, the_servo_loop_with_the_codec_of_silent_drives) {
  auto sut = std::make_unique<Servo>(true);
  const TimePoint start = time_from_ns(100'000'000'000);
  prove([&](int i) { sut->step(i, start + i * milliseconds(5)); });
  EXPECT_GT(sut->frames_seen(), kCycles);
}

// One sleep a cycle, in a thread with its period.
TEST(RtDaemon, the_servo_thread_sleeps_once_a_cycle) {
  constexpr int kPeriods = 1000;
  auto sut = std::make_unique<Servo>(false);
  test::RtUsage used;
  auto thread = linux_os::Thread::start("rt-servo", {.core = -1, .priority = 60}, [&] {
    linux_os::Periodic periodic(linux_os::monotonic_now(), std::chrono::microseconds(500));
    for (int i = 0; i < kWarmUp; ++i) sut->step(i, linux_os::monotonic_now());
    const test::RtUsage before = test::RtUsage::now();
    for (int i = 0; i < kPeriods; ++i) {
      periodic.wait();
      const test::RtSection section;
      sut->step(kWarmUp + i, linux_os::monotonic_now());
    }
    used = test::RtUsage::now().since(before);
  });
  ASSERT_TRUE(thread);
  thread->join();
  EXPECT_LE(used.voluntary_switches, kPeriods);
}

}  // namespace
}  // namespace gannet::daemon

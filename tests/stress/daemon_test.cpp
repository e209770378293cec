// The daemon's loops, each in a thread of its own and as fast as it can, with everything that
// crosses between them: frames, targets, commands, parameters, reports, events. A short time; run
// also under ThreadSanitizer.
#include <gtest/gtest.h>

#include <memory>
#include <thread>

#include "platform/linux/clock.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/daemon/capture_loop.hpp"
#include "src/daemon/reports.hpp"
#include "src/daemon/servo_loop.hpp"
#include "src/daemon/vision_loop.hpp"
#include "tests/support/daemon_fakes.hpp"

namespace gannet::daemon {
namespace {

using linux_os::monotonic_now;
using std::chrono::milliseconds;

StereoRig rig() {
  StereoRig rig;
  rig.body_from_hand = Transform<Body, Hand>{};
  return rig;
}

TEST(StressDaemon, everything_crosses_whole_and_every_lease_comes_home) {
  test::FakeCamera camera;
  test::FakeTracker tracker;
  test::FakeBus bus;
  test::FakeDrives drives(6);
  test::FakeInput estop;
  vehicle::VehicleConfig config;
  config.kind = "rov";
  auto vehicle = std::move(*vehicle::create_vehicle(config));
  auto law = std::move(*servo::create_servo_law({}, rig()));
  auto pool = std::move(*linux_os::WorkerPool::create("stress", {{}}));
  auto lines = std::make_unique<ReportLines>();
  SharedFacts facts;
  FrameLine to_vision(4), to_archive(4);
  SpscRing<TargetChoice> choices(4);
  SpscRing<SeenTarget> targets(16);
  SpscRing<ServoCommand> commands(8);
  LatestValue<servo::ServoParams> params;
  CaptureLoop capture({&camera, &to_vision, &lines->capture, &lines->capture_events, &facts}, {});
  VisionLoop vision({&tracker, pool.get(), &to_vision, &to_archive, &choices, &targets,
                     &lines->vision, &lines->vision_events, &facts},
                    true, milliseconds(100));
  ServoLoop servo({vehicle.get(), law.get(), &bus, &drives, &estop, nullptr, &targets, &commands,
                   &params, &lines->servo, &lines->servo_events, &facts},
                  rig(), safety::SafetyConfig{}, track::FilterConfig{}, servo::ServoParams{},
                  milliseconds(1));
  std::thread threads[] = {std::thread([&] {
                             while (!facts.stop) {
                               capture.step(monotonic_now(), {});
                               std::this_thread::yield();
                             }
                           }),
                           std::thread([&] {
                             while (!facts.stop) {
                               to_vision.wait(monotonic_now() + milliseconds(5));
                               vision.step(monotonic_now());
                             }
                           }),
                           std::thread([&] {
                             while (!facts.stop) {
                               servo.step(monotonic_now());
                               std::this_thread::yield();
                             }
                           }),
                           std::thread([&] {
                             TakenFrame taken;
                             while (!facts.stop) {
                               to_archive.wait(monotonic_now() + milliseconds(5));
                               while (to_archive.pop(taken)) taken = TakenFrame();
                             }
                           })};
  Reports reports(lines.get());
  const TimePoint end = monotonic_now() + milliseconds(500);
  for (std::uint64_t i = 1; monotonic_now() < end; ++i) {
    choices.push(
        {TargetChoice::Kind::kModel, static_cast<int>(i % 2), {}, static_cast<std::uint32_t>(i)});
    ServoCommand command;
    command.request = i % 2 == 0 ? safety::Request::kArm : safety::Request::kDisarm;
    command.number = i;
    commands.push(command);
    params.write(servo::ServoParams{});
    reports.refresh();
    EXPECT_LE(reports.servo().supervisor.state, safety::State::kFaulted);
    EXPECT_EQ(reports.capture().loop.cycles, reports.capture().loop.timer.stages()[0].count);
    std::this_thread::sleep_for(milliseconds(2));
  }
  facts.stop = true;
  for (std::thread& thread : threads) thread.join();
  reports.refresh();
  EXPECT_GT(reports.vision().frames, 10u);
  EXPECT_GT(reports.servo().loop.cycles, 10u);
  EXPECT_NE(reports.servo().supervisor.cause, safety::Cause::kInternalFault);
  for (FrameLine* line : {&to_vision, &to_archive}) {
    for (TakenFrame taken; line->pop(taken);) {
    }
  }
  EXPECT_EQ(camera.at_home(), 8);
}

}  // namespace
}  // namespace gannet::daemon

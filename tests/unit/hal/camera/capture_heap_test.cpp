// Proof that live captures take no heap: delivering, waiting, lost and back again.
#include <gtest/gtest.h>

#include <optional>

#include "hal/camera/replay_camera.hpp"
#include "hal/camera/simulated_camera.hpp"
#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"
#include "tests/support/count_heap.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::hal {
namespace {

using std::chrono::milliseconds;

// Captures with the heap counted; what was captured goes home at once.
class Counted {
 public:
  explicit Counted(StereoCamera& camera) : camera_(camera) {}
  CaptureStatus capture() {
    const std::uint64_t before = test::heap_calls;
    CaptureStatus status;
    {
      StereoFrame frame;
      status = camera_.capture(linux_os::monotonic_now(), milliseconds(10), frame);
    }
    heap_calls += test::heap_calls - before;
    return status;
  }
  bool until(CaptureStatus wanted) {
    for (int i = 0; i < 500; ++i)
      if (capture() == wanted) return true;
    return false;
  }
  std::uint64_t heap_calls = 0;

 private:
  StereoCamera& camera_;
};

TEST(CaptureHeap, the_simulated_camera_takes_none) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizers bring their own heap";
  const test::TemporaryFolder folder;
  const SimulatedCameraConfig config = {.name = folder / "frames", .silence_s = 0.05};
  const auto make_world = [&] {
    return std::move(SharedFramesWriter::create(config.name, {})).value();
  };
  std::optional<SharedFramesWriter> world(make_world());
  const auto camera = std::move(SimulatedCamera::create(config, Pace::kLive)).value();
  ASSERT_TRUE(camera->start());
  Counted sut(*camera);
  const auto publish = [&] {
    world->begin_frame();
    const TimePoint now = linux_os::monotonic_now();
    world->publish(now, now);
  };
  for (int i = 0; i < 20; ++i) {
    publish();
    ASSERT_EQ(sut.capture(), CaptureStatus::kFrame);
  }
  EXPECT_EQ(sut.capture(), CaptureStatus::kNothing);
  world.reset();
  ASSERT_TRUE(sut.until(CaptureStatus::kLost));
  world.emplace(make_world());
  bool back = false;
  for (int i = 0; i < 500 && !back; ++i) {
    publish();
    back = sut.capture() == CaptureStatus::kFrame;
  }
  EXPECT_TRUE(back);
  EXPECT_EQ(sut.heap_calls, 0u);
}

TEST(CaptureHeap, the_replay_camera_takes_none) {
  if (!test::kCountsHeap) GTEST_SKIP() << "the sanitizers bring their own heap";
  const test::TemporaryFolder folder;
  for (const char* side : {"left", "right"}) {
    std::filesystem::create_directories(folder.path() / side);
    for (int i = 0; i < 5; ++i)
      ASSERT_TRUE(linux_os::write_file(folder / (side + ("/" + std::to_string(i) + ".png")),
                                       std::string("x")));
  }
  const DecodeImage decode = [](std::span<const std::uint8_t>) -> Result<Image> {
    return Image(8, 8, PixelFormat::kRgb24);
  };
  const auto camera =
      std::move(ReplayCamera::create({.directory = folder.path().string(), .rate_hz = 200}, decode,
                                     Pace::kLive))
          .value();
  ASSERT_TRUE(camera->start());
  Counted sut(*camera);
  EXPECT_TRUE(sut.until(CaptureStatus::kFinished));
  EXPECT_EQ(sut.heap_calls, 0u);
}

}  // namespace
}  // namespace gannet::hal

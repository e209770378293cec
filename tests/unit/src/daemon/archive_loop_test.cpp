#include "src/daemon/archive_loop.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "hal/camera/frame_directory.hpp"
#include "tests/support/daemon_fakes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::daemon {
namespace {

config::FramesConfig into(const std::string& directory) { return {"directory", directory}; }

TEST(ArchiveLoop, none_keeps_nothing) {
  EventPort events;
  const auto sut = ArchiveLoop::create({}, &events);
  ASSERT_TRUE(sut);
  EXPECT_EQ(*sut, nullptr);
}

TEST(ArchiveLoop, what_it_keeps_can_be_replayed_and_the_leases_go_home) {
  const test::TemporaryFolder folder;
  test::FakeCamera camera;
  EventPort events;
  {
    auto sut = ArchiveLoop::create(into(folder / "record"), &events);
    ASSERT_TRUE(sut) << sut.error().text;
    for (int i = 0; i < 3; ++i) {
      TakenFrame taken;
      camera.capture(time_from_ns(1'000'000'000 + i * 33'000'000), {}, taken.frame);
      ASSERT_TRUE((*sut)->line().push(std::move(taken)));
    }
    EXPECT_EQ((*sut)->step({}), 3);
  }
  EXPECT_EQ(camera.at_home(), 8);
  const auto frames = hal::list_frames(folder / "record", 30);
  ASSERT_TRUE(frames) << frames.error().text;
  ASSERT_EQ(frames->pairs.size(), 3u);
  EXPECT_TRUE(frames->has_times);
  EXPECT_NEAR(frames->pairs[1].time_s - frames->pairs[0].time_s, 0.033, 1e-9);
}

TEST(ArchiveLoop, refuses_a_directory_with_a_recording) {
  const test::TemporaryFolder folder;
  EventPort events;
  ASSERT_TRUE(ArchiveLoop::create(into(folder / "record"), &events));
  const auto sut = ArchiveLoop::create(into(folder / "record"), &events);
  ASSERT_FALSE(sut);
  EXPECT_NE(sut.error().text.find("holds a recording"), std::string::npos);
  EXPECT_FALSE(ArchiveLoop::create(into("/proc/nowhere"), &events));
}

TEST(ArchiveLoop, a_failure_is_counted_and_told_once) {
  const test::TemporaryFolder folder;
  test::FakeCamera camera;
  EventPort events;
  auto sut = ArchiveLoop::create(into(folder / "record"), &events);
  ASSERT_TRUE(sut);
  std::filesystem::remove_all(folder / "record/right");
  for (int i = 0; i < 2; ++i) {
    TakenFrame taken;
    camera.capture({}, {}, taken.frame);
    (*sut)->line().push(std::move(taken));
  }
  EXPECT_EQ((*sut)->step({}), 0);
  EXPECT_EQ((*sut)->failures(), 2u);
  EXPECT_EQ(camera.at_home(), 8);
  Event event;
  EXPECT_TRUE(events.take(event));
  EXPECT_FALSE(events.take(event));
}

}  // namespace
}  // namespace gannet::daemon

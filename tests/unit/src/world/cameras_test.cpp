#include "src/world/cameras.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "src/world/scenario.hpp"
#include "src/world/shared_frame_sink.hpp"
#include "src/world/stage.hpp"
#include "src/world/texture_made.hpp"

namespace gannet::world {
namespace {

using std::chrono::milliseconds;

struct World1 {  // a small scene of drawn pictures
  World1() {
    scenario.camera.width = 64;
    scenario.camera.height = 48;
    scenario.camera.focal_px = 64;
    scenario.targets.resize(1);
  }
  Renderer renderer() const {
    std::vector<Texture> textures;
    textures.emplace_back(pebbles_picture(64, 1), Texture::Edge::kTile);
    textures.emplace_back(noise_picture(64, 2), Texture::Edge::kClamp);
    return Renderer(scenario.rig(), std::move(textures), {}, 1);
  }
  Scene scene(double time_s) const { return Stage(scenario, {{1}, 0, 0}, 1).scene(time_s); }
  Transform<World, LeftCamera> eye() const {
    return scenario.world_from_reference() * scenario.rig().hand_from_left;
  }
  Scenario scenario;
};

class CamerasTest : public ::testing::Test {
 protected:
  void make(bool in_background = false) {
    Cameras::Config config;
    config.period = milliseconds(30);
    config.latency = milliseconds(40);
    config.in_background = in_background;
    auto sink = SharedFrameSink::create(name_, 64, 48);
    ASSERT_TRUE(sink) << sink.error().text;
    auto made = Cameras::create(config, world_.renderer(), std::move(*sink), serial_);
    ASSERT_TRUE(made) << made.error().text;
    sut_ = std::move(*made);
    auto reader = hal::SharedFramesReader::open(name_);
    ASSERT_TRUE(reader) << reader.error().text;
    reader_ = std::move(*reader);
  }
  void expose(TimePoint t) {
    if (sut_->due(t)) sut_->expose(t, 0, world_.scene(0), world_.eye());
  }
  const std::string name_ = "gannet-cameras-test-" + std::to_string(getpid());
  World1 world_;
  Serial serial_;
  std::unique_ptr<Cameras> sut_;
  std::unique_ptr<hal::SharedFramesReader> reader_;
};

TEST_F(CamerasTest, pairs_come_in_time_and_are_seen_later) {
  make();
  sut_->start(time_from_ns(0));
  int seen = 0;
  for (int ms = 0; ms <= 300; ms += 5) {
    const TimePoint now = time_from_ns(ms * 1'000'000);
    expose(now);
    hal::StereoFrame frame;
    while (reader_->take(now, frame) == hal::CaptureStatus::kFrame) {
      EXPECT_EQ(now - frame.capture_time, milliseconds(40));
      EXPECT_EQ(to_ns(frame.capture_time), seen * 30'000'000);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 9);  // 0, 30 … 240
  EXPECT_EQ(sut_->counters().frames, 11u);
}

TEST_F(CamerasTest, pixels_repeat_and_show_something) {
  std::vector<std::uint8_t> first;
  for (int run = 0; run < 2; ++run) {
    make();
    sut_->start(time_from_ns(0));
    expose(time_from_ns(0));
    hal::StereoFrame frame;
    ASSERT_EQ(reader_->take(time_from_ns(50'000'000), frame), hal::CaptureStatus::kFrame);
    const auto* bytes = frame.left.plane[0];
    std::vector<std::uint8_t> pixels(bytes, bytes + frame.left.stride[0] * frame.left.height);
    EXPECT_GT(*std::max_element(pixels.begin(), pixels.end()), 100);
    if (run == 0)
      first = pixels;
    else
      EXPECT_EQ(pixels, first);
    frame = {};
    reader_.reset();
    sut_.reset();
  }
}

TEST_F(CamerasTest, blind_they_give_nothing) {
  make();
  sut_->start(time_from_ns(0));
  sut_->set_blind(true);
  expose(time_from_ns(0));
  sut_->set_blind(false);
  expose(time_from_ns(30'000'000));
  EXPECT_EQ(sut_->counters().frames, 1u);
  EXPECT_EQ(sut_->counters().withheld, 1u);
}

TEST_F(CamerasTest, a_share_is_dropped) {
  make();
  sut_->start(time_from_ns(0));
  sut_->set_drop_share(0.3);
  hal::StereoFrame frame;
  for (int i = 0; i < 200; ++i) {
    const TimePoint t = time_from_ns(i * std::int64_t{30'000'000});
    expose(t);
    while (reader_->take(t, frame) == hal::CaptureStatus::kFrame) frame = {};
  }
  EXPECT_NEAR(static_cast<double>(sut_->counters().withheld) / 200, 0.3, 0.1);
}

TEST_F(CamerasTest, frozen_they_repeat_picture_and_stamp) {
  make();
  sut_->start(time_from_ns(0));
  std::vector<std::vector<std::uint8_t>> pictures;
  std::vector<TimePoint> stamps;
  hal::StereoFrame frame;
  for (int i = 0; i < 6; ++i) {
    sut_->faults().frozen = i >= 2 && i < 4;
    const TimePoint t = time_from_ns(i * std::int64_t{30'000'000});
    expose(t);
    ASSERT_EQ(reader_->take(t + milliseconds(40), frame), hal::CaptureStatus::kFrame) << i;
    const auto* bytes = frame.left.plane[0];
    pictures.emplace_back(bytes, bytes + frame.left.stride[0] * frame.left.height);
    stamps.push_back(frame.capture_time);
    frame = {};
  }
  EXPECT_NE(pictures[0], pictures[1]);  // noise differs
  for (const std::size_t i : {2u, 3u}) {
    EXPECT_EQ(pictures[i], pictures[1]);
    EXPECT_EQ(stamps[i], stamps[1]);
  }
  EXPECT_EQ(stamps[4], time_from_ns(120'000'000));
}

TEST_F(CamerasTest, backward_stamps_are_refused_by_the_reader) {
  make();
  sut_->start(time_from_ns(0));
  hal::StereoFrame frame;
  expose(time_from_ns(0));
  expose(time_from_ns(30'000'000));
  EXPECT_EQ(reader_->take(time_from_ns(40'000'000), frame), hal::CaptureStatus::kFrame);
  EXPECT_EQ(reader_->take(time_from_ns(70'000'000), frame), hal::CaptureStatus::kFrame);
  sut_->faults().backward_since = time_from_ns(31'000'000);
  expose(time_from_ns(60'000'000));
  EXPECT_EQ(reader_->take(time_from_ns(100'000'000), frame), hal::CaptureStatus::kBroken);
}

TEST_F(CamerasTest, a_late_camera_delays_the_pair_and_never_turns_it_round) {
  make();
  sut_->start(time_from_ns(0));
  sut_->faults().late[kRightSide] = milliseconds(35);
  expose(time_from_ns(0));
  sut_->faults() = {};
  expose(time_from_ns(30'000'000));
  hal::StereoFrame frame;
  EXPECT_EQ(reader_->take(time_from_ns(74'000'000), frame), hal::CaptureStatus::kNothing);
  EXPECT_EQ(reader_->take(time_from_ns(75'000'000), frame), hal::CaptureStatus::kFrame);
  EXPECT_EQ(reader_->take(time_from_ns(75'000'000), frame), hal::CaptureStatus::kFrame);
}

TEST_F(CamerasTest, live_they_draw_beside_us) {
  make(true);
  sut_->start(time_from_ns(0));
  expose(time_from_ns(0));
  for (int i = 0; i < 400 && sut_->counters().frames == 0; ++i)
    std::this_thread::sleep_for(milliseconds(5));
  EXPECT_EQ(sut_->counters().frames, 1u);
}

}  // namespace
}  // namespace gannet::world

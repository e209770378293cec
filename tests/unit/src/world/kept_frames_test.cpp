#include "src/world/kept_frames.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "hal/camera/image.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::world {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(KeptFrames, keeps_every_nth_pair_as_a_folder_that_can_be_replayed) {
  const test::TemporaryFolder folder;
  auto sut = KeptFrames::create(folder / "frames", 3);
  ASSERT_TRUE(sut) << sut.error().text;
  const hal::Image image(16, 8, hal::PixelFormat::kYuyv);
  for (std::uint64_t number = 1; number <= 7; ++number)
    sut->take(number, static_cast<double>(number) / 30, image.view(), image.view());
  EXPECT_EQ(sut->failures(), 0u);
  EXPECT_EQ(text_of(folder / "frames/times.csv"),
            "frame,time_s\n00000001,0.033333\n00000004,0.133333\n00000007,0.233333\n");
  for (const char* name : {"00000001", "00000004", "00000007"})
    for (const char* eye : {"left/", "right/"})
      EXPECT_TRUE(std::filesystem::exists(folder / ("frames/" + std::string(eye) + name + ".jpg")));
}

TEST(KeptFrames, keeps_none_unless_asked) {
  const test::TemporaryFolder folder;
  auto sut = KeptFrames::create(folder / "frames", 0);
  ASSERT_TRUE(sut);
  const hal::Image image(16, 8, hal::PixelFormat::kYuyv);
  sut->take(1, 0, image.view(), image.view());
  EXPECT_FALSE(std::filesystem::exists(folder / "frames"));
}

TEST(KeptFrames, counts_what_could_not_be_written) {
  const test::TemporaryFolder folder;
  auto sut = KeptFrames::create(folder / "frames", 1);
  ASSERT_TRUE(sut);
  std::filesystem::remove_all(folder / "frames");
  const hal::Image image(16, 8, hal::PixelFormat::kYuyv);
  sut->take(1, 0, image.view(), image.view());
  EXPECT_EQ(sut->failures(), 1u);
}

}  // namespace
}  // namespace gannet::world

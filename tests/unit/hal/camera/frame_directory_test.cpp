#include "hal/camera/frame_directory.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "platform/linux/whole_file.hpp"

namespace gannet::hal {
namespace {

namespace fs = std::filesystem;

class FrameDirectoryTest : public ::testing::Test {
 protected:
  ~FrameDirectoryTest() override { fs::remove_all(folder_); }
  void put(const std::string& name, const std::string& text = "") {
    fs::create_directories((folder_ / name).parent_path());
    ASSERT_TRUE(linux_os::write_file((folder_ / name).string(), text));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Result<FrameDirectory> list() const { return list_frames(folder_.string(), 20); }
  std::string error() const {
    const auto result = list();
    return result ? "no error" : result.error().text;
  }
  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("frame_directory_" + std::to_string(getpid()));
};

TEST_F(FrameDirectoryTest, pairs_come_in_name_order_with_times_by_the_rate) {
  for (const char* name : {"0002", "0000", "0001"}) {
    put(std::string("left/") + name + ".png");
    put(std::string("right/") + name + ".JPG");
  }
  put("left/.hidden.png");
  put("left/notes.txt");
  const auto sut = list();
  ASSERT_TRUE(sut) << sut.error().text;
  ASSERT_EQ(sut->pairs.size(), 3u);
  EXPECT_EQ(sut->pairs[2].name, "0002");
  EXPECT_EQ(sut->pairs[2].right, path("right/0002.JPG"));
  EXPECT_DOUBLE_EQ(sut->pairs[2].time_s, 0.1);
  EXPECT_FALSE(sut->has_times);
  EXPECT_DOUBLE_EQ(sut->interval_s, 0.05);
}

TEST_F(FrameDirectoryTest, names_that_differ_on_both_sides_are_paired_by_order) {
  put("left/left_1.png"), put("left/left_2.png");
  put("right/right_1.png"), put("right/right_2.png");
  const auto sut = list();
  ASSERT_TRUE(sut);
  EXPECT_EQ(sut->pairs[1].right, path("right/right_2.png"));
}

TEST_F(FrameDirectoryTest, an_image_without_its_twin_is_named) {
  put("left/1.png"), put("left/2.png"), put("right/1.png");
  EXPECT_EQ(error(), path("left/2.png") + ": no right image of that name");
  put("left/3.png"), put("right/2.png"), put("right/4.png"), put("right/3.png");
  EXPECT_EQ(error(), path("right/4.png") + ": no left image of that name");
}

TEST_F(FrameDirectoryTest, missing_and_empty_folders_are_named) {
  EXPECT_NE(error().find(path("left") + ": cannot list"), std::string::npos) << error();
  put("left/1.png"), put("right/readme");
  EXPECT_EQ(error(), path("right") + ": no .png, .jpg or .jpeg file in it");
}

TEST_F(FrameDirectoryTest, times_are_found_by_name_by_number_and_by_order) {
  put("left/a_07.png"), put("left/a_09.png");
  put("right/a_07.png"), put("right/a_09.png");
  for (const char* frames : {"a_07 a_09", "7 9", "0 1"}) {
    const std::string first(frames, std::string(frames).find(' '));
    const std::string second(std::string(frames).substr(first.size() + 1));
    put("times.csv", "frame,time_s\r\n" + first + ",1.5\r\n" + second + ", 1.75\n\n");
    const auto sut = list();
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_TRUE(sut->has_times);
    EXPECT_DOUBLE_EQ(sut->pairs[0].time_s, 1.5);
    EXPECT_DOUBLE_EQ(sut->pairs[1].time_s, 1.75);
    EXPECT_DOUBLE_EQ(sut->interval_s, 0.25);
  }
}

TEST_F(FrameDirectoryTest, bad_times_are_refused_with_their_line) {
  put("left/1.png"), put("left/2.png"), put("right/1.png"), put("right/2.png");
  const std::string times = path("times.csv");
  put("times.csv", "time\n1,2\n");
  EXPECT_EQ(error(), times + ":1: the first line must be `frame,time_s`");
  put("times.csv", "frame,time_s\n1,zero\n");
  EXPECT_EQ(error(), times + ":2: 'zero' is not a time in seconds");
  put("times.csv", "frame,time_s\n1,nan\n");
  EXPECT_EQ(error(), times + ":2: 'nan' is not a time in seconds");
  put("times.csv", "frame,time_s\n1,0.5\n2,0.5\n");
  EXPECT_EQ(error(), times + ":3: times must rise from row to row");
  put("times.csv", "frame,time_s\n1,0.5\n");
  EXPECT_EQ(error(), times + ": 1 rows for 2 pairs, and their names do not fit");
  put("times.csv", "frame,time_s\n2,0.5\n1,0.6\n");
  EXPECT_EQ(error(),
            times + ": the time of '2' is not after that of '1', the pair before it by name");
}

}  // namespace
}  // namespace gannet::hal

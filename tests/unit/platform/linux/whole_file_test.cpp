#include "platform/linux/whole_file.hpp"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

namespace gannet::linux_os {
namespace {

namespace fs = std::filesystem;

class WholeFile : public ::testing::Test {
 protected:
  WholeFile() { fs::create_directories(folder_); }
  ~WholeFile() override { fs::remove_all(folder_); }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  int files() const {
    int count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++count;
    return count;
  }
  const fs::path folder_ =
      fs::path(::testing::TempDir()) / ("whole_file_" + std::to_string(getpid()));
};

TEST_F(WholeFile, what_is_written_is_read_back_and_nothing_else_is_left) {
  ASSERT_TRUE(write_file(path("a"), std::string("first, longer")));
  ASSERT_TRUE(write_file(path("a"), std::string("second")));
  const auto sut = read_file(path("a"), 100);
  ASSERT_TRUE(sut);
  EXPECT_EQ(std::string(sut->begin(), sut->end()), "second");
  EXPECT_EQ(files(), 1);
  ASSERT_TRUE(write_file(path("empty"), std::string()));
  EXPECT_TRUE(read_file(path("empty"), 0)->empty());
}

TEST_F(WholeFile, what_cannot_be_read_names_the_path_and_the_reason) {
  const auto missing = read_file(path("nowhere"), 100);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().text, path("nowhere") + ": cannot open: No such file or directory");
  EXPECT_EQ(read_file(folder_.string(), 100).error().text,
            folder_.string() + ": not a regular file");
  ASSERT_TRUE(write_file(path("big"), std::string(101, 'x')));
  EXPECT_EQ(read_file(path("big"), 100).error().text,
            path("big") + ": 101 bytes, more than the 100 that are accepted");
}

TEST_F(WholeFile, a_failed_write_leaves_no_trace) {
  fs::create_directories(folder_ / "in_the_way" / "full");  // a rename onto it must fail
  EXPECT_FALSE(write_file(path("in_the_way"), std::string("x")));
  EXPECT_EQ(files(), 1);
  EXPECT_FALSE(write_file(path("no/such/folder"), std::string("x")));
}

TEST_F(WholeFile, a_device_is_written_into_and_not_replaced) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const int reader = open(path("pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_file(path("pipe"), std::string("through")));
  char got[16] = {};
  EXPECT_EQ(read(reader, got, sizeof got), 7);
  EXPECT_STREQ(got, "through");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(path("pipe")));
  EXPECT_EQ(files(), 1);
}

TEST_F(WholeFile, a_symbolic_link_stays_and_the_file_behind_it_is_replaced) {
  ASSERT_TRUE(write_file(path("file"), std::string("old")));
  fs::create_symlink("file", path("link"));
  ASSERT_TRUE(write_file(path("link"), std::string("new")));
  EXPECT_TRUE(fs::is_symlink(path("link")));
  const auto sut = read_file(path("file"), 100);
  ASSERT_TRUE(sut);
  EXPECT_EQ(std::string(sut->begin(), sut->end()), "new");
}

}  // namespace
}  // namespace gannet::linux_os

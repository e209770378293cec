#include "platform/linux/whole_file.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gannet::linux_os

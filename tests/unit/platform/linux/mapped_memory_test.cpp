#include "platform/linux/mapped_memory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace gannet::linux_os {
namespace {

TEST(MappedMemory, both_sides_see_the_same_bytes) {
  const test::TemporaryFolder folder;
  auto writer = MappedMemory::create(folder / "shared", 4096);
  ASSERT_TRUE(writer);
  auto reader = MappedMemory::open(folder / "shared", false);
  ASSERT_TRUE(reader);
  EXPECT_EQ(reader->size(), 4096u);
  EXPECT_EQ(reader->data()[17], std::byte{0});
  writer->data()[17] = std::byte{42};
  EXPECT_EQ(reader->data()[17], std::byte{42});
}

TEST(MappedMemory, a_reader_keeps_its_bytes_when_the_owner_goes) {
  const test::TemporaryFolder folder;
  auto writer = MappedMemory::create(folder / "shared", 100);
  ASSERT_TRUE(writer);
  writer->data()[99] = std::byte{7};
  auto reader = MappedMemory::open(folder / "shared", true);
  ASSERT_TRUE(reader);
  { const MappedMemory gone = std::move(*writer); }
  EXPECT_FALSE(std::filesystem::exists(folder / "shared"));
  EXPECT_EQ(reader->data()[99], std::byte{7});
}

TEST(MappedMemory, says_which_file_is_wrong) {
  const test::TemporaryFolder folder;
  const auto missing = MappedMemory::open(folder / "missing", false);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text.find("missing"), std::string::npos);
  EXPECT_NE(missing.error().text.find("No such file"), std::string::npos);
  std::ofstream(folder / "empty").close();
  EXPECT_FALSE(MappedMemory::open(folder / "empty", false));
  EXPECT_FALSE(MappedMemory::open(folder.path().string(), false));
  EXPECT_FALSE(MappedMemory::create(folder / "no/such/folder", 10));
  EXPECT_FALSE(MappedMemory::create(folder / "nothing", 0));
  EXPECT_FALSE(std::filesystem::exists(folder / "nothing.new"));
}

TEST(MappedMemory, a_new_one_replaces_an_old_one) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "shared") << "left behind";
  auto sut = MappedMemory::create(folder / "shared", 64);
  ASSERT_TRUE(sut);
  EXPECT_EQ(std::filesystem::file_size(folder / "shared"), 64u);
}

}  // namespace
}  // namespace gannet::linux_os

#include "src/modeldb/model_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "platform/base/random.hpp"
#include "platform/linux/whole_file.hpp"

namespace gannet::modeldb {
namespace {

vision::PhotoPatch random_patch(std::uint64_t seed) {
  Random random(seed);
  vision::PhotoPatch p;
  p.name = "crab \"of\" P001";
  p.width = 20 + random.below(30);
  p.height = 20 + random.below(30);
  for (int i = 0; i < p.width * p.height; ++i) {
    for (int c = 0; c < 3; ++c) p.yuv.push_back(static_cast<std::uint8_t>(random.below(256)));
    p.mask.push_back(random.below(3) == 0 ? 0 : 255);
  }
  p.distance_m = 0.2 + random.uniform();
  p.fx = 400 + 500 * random.uniform();
  p.fy = 400 + 500 * random.uniform();
  p.centre_px = {p.width * random.uniform(), p.height * random.uniform()};
  p.size_m = {0.01 + random.uniform(), 0.01 + random.uniform()};
  p.background = {255 * random.uniform_f(), 255 * random.uniform_f(), 255 * random.uniform_f()};
  p.background_hue = static_cast<std::uint8_t>(random.below(256));
  return p;
}

void expect_same(const vision::PhotoPatch& a, const vision::PhotoPatch& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.yuv, b.yuv);
  EXPECT_EQ(a.mask, b.mask);
  EXPECT_EQ(a.distance_m, b.distance_m);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.centre_px, b.centre_px);
  EXPECT_EQ(a.size_m, b.size_m);
  EXPECT_EQ(a.background.y, b.background.y);
  EXPECT_EQ(a.background.u, b.background.u);
  EXPECT_EQ(a.background.v, b.background.v);
  EXPECT_EQ(a.background_hue, b.background_hue);
}

std::vector<std::uint8_t> encoded(const vision::PhotoPatch& patch) {
  auto bytes = encode_model(patch);
  EXPECT_TRUE(bytes);
  return *bytes;
}

std::string error_of(const std::vector<std::uint8_t>& bytes) {
  const auto patch = decode_model(bytes, "crab.gannet");
  return patch ? "none" : patch.error().text;
}

std::vector<std::uint8_t> replaced(std::vector<std::uint8_t> bytes, const std::string& what,
                                   const std::string& by) {
  const auto at = std::search(bytes.begin(), bytes.end(), what.begin(), what.end());
  EXPECT_NE(at, bytes.end()) << what;
  const auto next = bytes.erase(at, at + static_cast<std::ptrdiff_t>(what.size()));
  bytes.insert(next, by.begin(), by.end());
  return bytes;
}

TEST(ModelFile, everything_comes_back_to_the_last_bit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const vision::PhotoPatch patch = random_patch(seed);
    const auto sut = decode_model(encoded(patch), "x");
    ASSERT_TRUE(sut) << sut.error().text;
    expect_same(*sut, patch);
  }
}

TEST(ModelFile, is_written_and_read_as_a_file) {
  const auto path = std::filesystem::temp_directory_path() / "gannet_model_test.gannet";
  const vision::PhotoPatch patch = random_patch(3);
  ASSERT_TRUE(save_model(path.string(), patch));
  const auto sut = load_model(path.string());
  std::filesystem::remove(path);
  ASSERT_TRUE(sut) << sut.error().text;
  expect_same(*sut, patch);
}

TEST(ModelFile, a_file_that_ends_anywhere_is_refused_with_its_name) {
  const auto bytes = encoded(random_patch(4));
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 40) {
    const std::vector<std::uint8_t> cut(bytes.begin(),
                                        bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_EQ(error_of(cut).rfind("crab.gannet: ", 0), 0u) << size << " " << error_of(cut);
  }
  auto longer = bytes;
  longer.push_back(0);
  EXPECT_NE(error_of(longer).find("instead of"), std::string::npos) << error_of(longer);
}

TEST(ModelFile, wrong_headers_are_refused_with_their_line) {
  const auto bytes = encoded(random_patch(5));
  EXPECT_EQ(error_of(replaced(bytes, "# gannet model", "# gannet medal")),
            "crab.gannet: is not a gannet model; `gannet model build` makes one");
  EXPECT_EQ(error_of(replaced(bytes, "format = 1", "format = 2")),
            "crab.gannet:2: format: 2 is not known; this program reads format 1");
  EXPECT_NE(error_of(replaced(bytes, "\"yuv-bt601-full\"", "\"srgb\"")).find("photo.colour_space"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(bytes, "distance_m = ", "distance_m = -")).find("is outside"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(bytes, "[background]", "[relief]")).find("unknown key"),
            std::string::npos);
  EXPECT_NE(error_of(replaced(bytes, "name = \"crab", "name = \"\\u0007crab")).find("invisible"),
            std::string::npos);
  EXPECT_EQ(error_of(replaced(bytes, "hue = ", "# hue = ")),
            "crab.gannet: the header has no background.hue");
}

TEST(ModelFile, a_broken_picture_is_refused) {
  auto bytes = encoded(random_patch(6));
  bytes[bytes.size() - 40] ^= 0x55;
  EXPECT_EQ(error_of(bytes).rfind("crab.gannet: its picture: ", 0), 0u) << error_of(bytes);
}

TEST(ModelFile, an_empty_mask_and_an_origin_outside_are_refused) {
  vision::PhotoPatch patch = random_patch(7);
  patch.centre_px.x() = patch.width + 1;
  EXPECT_NE(error_of(encoded(patch)).find("photo.origin_px"), std::string::npos);
  patch.mask.assign(patch.mask.size(), 0);
  EXPECT_NE(error_of(encoded(patch)).find("mask is empty"), std::string::npos);
}

TEST(ModelFile, a_missing_file_is_told) {
  const auto patch = load_model("no/such.gannet");
  ASSERT_FALSE(patch);
  EXPECT_EQ(patch.error().text.rfind("no/such.gannet", 0), 0u) << patch.error().text;
}

}  // namespace
}  // namespace gannet::modeldb

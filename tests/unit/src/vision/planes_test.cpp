// The passes over whole images: every table gives the bytes of the plain formulas.
#include "src/vision/kernels/planes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet::vision {
namespace {

std::vector<std::uint8_t> noise(int n, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(n));
  for (auto& b : out) b = static_cast<std::uint8_t>(random.below(256));
  if (seed % 4 == 0) std::fill(out.begin(), out.end(), 255);  // the sums' largest
  return out;
}

int pixel(const std::vector<std::uint8_t>& from, int width, int height, int x, int y) {
  return from[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width +
                                       std::clamp(x, 0, width - 1))];
}

int smoothed(const std::vector<std::uint8_t>& from, int width, int height, int x, int y) {
  constexpr int kWeights[] = {1, 4, 6, 4, 1};
  int sum = 128;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      sum += kWeights[dx + 2] * kWeights[dy + 2] * pixel(from, width, height, x + dx, y + dy);
    }
  }
  return sum >> 8;
}

class Planes : public testing::TestWithParam<const PlaneKernels*> {
 protected:
  const PlaneKernels& sut = *GetParam();
};

constexpr int kSizes[][2] = {{1, 1}, {2, 3}, {5, 4}, {31, 9}, {33, 8}, {64, 6}, {97, 11}};

TEST_P(Planes, smooth_with_the_binomial_weights) {
  std::uint64_t seed = 1;
  for (const auto& [w, h] : kSizes) {
    const auto from = noise(w * h, seed++);
    const int stride = w + 3;
    std::vector<std::uint8_t> to(static_cast<std::size_t>(stride * h), 77);
    std::vector<std::uint16_t> scratch(static_cast<std::size_t>(w) + 4);
    sut.smooth(from.data(), w, h, scratch.data(), to.data(), stride);
    for (int i = 0; i < stride * h; ++i) {
      const int x = i % stride;
      const int expected = x < w ? smoothed(from, w, h, x, i / stride) : 77;
      ASSERT_EQ(to[static_cast<std::size_t>(i)], expected) << w << i;
    }
  }
}

TEST_P(Planes, halve_by_the_mean_of_four) {
  std::uint64_t seed = 3;
  for (const auto& [w, h] : kSizes) {
    const auto from = noise(w * h, seed++);
    std::vector<std::uint8_t> to(from.size());
    sut.halve(from.data(), w, h, to.data());
    for (int y = 0; y < h / 2; ++y) {
      for (int x = 0; x < w / 2; ++x) {
        int sum = 2;
        for (const int k : {0, 1, 2, 3}) sum += pixel(from, w, h, 2 * x + k % 2, 2 * y + k / 2);
        ASSERT_EQ(to[static_cast<std::size_t>(y * (w / 2) + x)], sum >> 2);
      }
    }
  }
}

TEST_P(Planes, halve_packed_pixels_like_their_planes) {
  for (const int luma : {0, 1}) {
    for (const int half : {1, 7, 32, 45}) {
      const auto top = noise(4 * half, 5), bottom = noise(4 * half, 6);
      const auto n = static_cast<std::size_t>(half);
      std::vector<std::uint8_t> y(n), u(n), v(n);
      sut.halve_packed(top.data(), bottom.data(), half, luma, y.data(), u.data(), v.data());
      for (std::size_t i = 0; i < n; ++i) {
        const auto at = 4 * i + static_cast<std::size_t>(luma);
        const auto chroma = 4 * i + 1 - static_cast<std::size_t>(luma);
        ASSERT_EQ(y[i], (top[at] + top[at + 2] + bottom[at] + bottom[at + 2] + 2) >> 2);
        ASSERT_EQ(u[i], (top[chroma] + bottom[chroma] + 1) >> 1);
        ASSERT_EQ(v[i], (top[chroma + 2] + bottom[chroma + 2] + 1) >> 1);
      }
    }
  }
}

TEST_P(Planes, limits_are_the_least_and_the_largest) {
  for (const int n : {1, 15, 33, 1000}) {
    const auto from = noise(n, static_cast<std::uint64_t>(n));
    std::uint8_t low = 0, high = 0;
    sut.limits(from.data(), n, &low, &high);
    EXPECT_EQ(low, *std::min_element(from.begin(), from.end()));
    EXPECT_EQ(high, *std::max_element(from.begin(), from.end()));
  }
}

TEST_P(Planes, pack_rounds_exactly_for_every_range) {
  std::vector<std::uint8_t> all(600);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint8_t>(i & 255);
  const std::uint8_t* const yuv[3] = {all.data(), all.data() + 40, all.data() + 80};
  std::vector<std::uint32_t> cells(520);
  for (int low = 0; low < 256; low += 5) {
    for (int high = low; high < 256; ++high) {
      const Stretch s[3] = {Stretch::between(low, high), Stretch::between(low, high),
                            Stretch::between(low, high)};
      const int range = std::max(high - low, 16);
      ASSERT_EQ(s[0].range, range);
      sut.pack(yuv, 520, s, cells.data());
      for (std::size_t i = 0; i < cells.size(); ++i) {
        std::uint32_t expected = 1u << 24;
        for (std::size_t c = 0; c < 3; ++c) {
          const int step = ((yuv[c][i] - low) * 254 + range) / (2 * range);
          expected |= static_cast<std::uint32_t>(std::clamp(step, 0, 127)) << (8 * c);
        }
        ASSERT_EQ(cells[i], expected) << low << ' ' << high << ' ' << i;
      }
    }
  }
}

std::vector<const PlaneKernels*> tables() {
  std::vector<const PlaneKernels*> all = {&kScalarPlaneKernels};
  if (&plane_kernels() != all[0]) all.push_back(&plane_kernels());
  return all;
}

INSTANTIATE_TEST_SUITE_P(Tables, Planes, testing::ValuesIn(tables()),
                         [](const auto& made) { return made.param->name; });

}  // namespace
}  // namespace gannet::vision

// Every kernel variant that runs here gives the bits of the scalar one: awkward lengths,
// misaligned arrays, points outside, behind, at infinity and not a number.
#include "src/vision/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "platform/base/random.hpp"
#include "src/vision/kernel_choice.hpp"

namespace gannet::vision {
namespace {

constexpr int kWidth = 97;
constexpr int kHeight = 61;

struct Data {
  explicit Data(std::uint64_t seed, int points, int shift) : n(padded(points)), random(seed) {
    const auto size = static_cast<std::size_t>(n + shift);
    x.assign(size, std::numeric_limits<float>::quiet_NaN());
    y = x;
    model.assign(4 * size, 0);
    hue.assign(size, 0);
    flags.assign(size, 0);
    hue_value.assign(size, 0);
    for (int i = 0; i < points; ++i) {
      const auto at = static_cast<std::size_t>(i + shift);
      x[at] = 0.2f * (random.uniform_f() - 0.5f);
      y[at] = 0.2f * (random.uniform_f() - 0.5f);
      if (random.below(40) == 0) x[at] = std::numeric_limits<float>::infinity();
      hue[at] = static_cast<std::uint8_t>(random.below(256));
      flags[at] = random.below(2) == 0 ? 0xFF : 0;
      hue_value[at] = static_cast<std::uint16_t>(random.below(65536));
    }
    for (auto& m : model) m = static_cast<std::int8_t>(random.below(128) - 64);
    cells.assign(kWidth * kHeight + 16, 0);
    hue_cells.assign(kWidth * kHeight + 16, 0);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const auto at = static_cast<std::size_t>(i);
      cells[at] = static_cast<std::uint32_t>(random.below(128)) |
                  static_cast<std::uint32_t>(random.below(128)) << 8 |
                  static_cast<std::uint32_t>(random.below(128)) << 16 | 1u << 24;
      hue_cells[at] = static_cast<std::uint16_t>(random.below(65536));
    }
    view = {{}, kWidth, kHeight, kWidth, kWidth * kHeight};
    for (float& h : view.h) h = 60 * (random.uniform_f() - 0.5f);
    view.h[2] = 40;
    view.h[5] = 30;
    view.h[6] = 4 * (random.uniform_f() - 0.5f);
    view.h[7] = 4 * (random.uniform_f() - 0.5f);
    view.h[8] = random.uniform_f();  // near zero: some points fall behind the camera
    for (float& e : view.e) e = random.uniform_f() - 0.3f;  // some roots are of negative numbers
    view.port[0] = 20;
    view.port[1] = 10;
    view.port[2] = 1;
  }

  int n;
  Random random;
  std::vector<float> x, y;
  std::vector<std::int8_t> model;
  std::vector<std::uint8_t> hue, flags;
  std::vector<std::uint16_t> hue_value, hue_cells;
  std::vector<std::uint32_t> cells;
  PlaneView view;
};

LensTable some_lens() {
  LensTable lens = {};
  for (int i = 0; i < LensTable::kSteps + 2; ++i) {
    lens.factor[i] = 1.0f - 0.0002f * static_cast<float>(i);
  }
  lens.r2_max = 0.81f;
  lens.scale = LensTable::kSteps / lens.r2_max;
  lens.p1 = 0.003f;
  lens.p2 = -0.002f;
  lens.fx = 40;
  lens.fy = 42;
  lens.cx = 48;
  lens.cy = 30;
  return lens;
}

template <class T>
bool same_bits(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

class KernelVariant : public testing::TestWithParam<const Kernels*> {
 protected:
  template <class Test>
  void for_many(Test&& test) {
    for (int seed = 1; seed <= 60; ++seed) {
      const int points = seed <= 40 ? seed * 3 : 200 + seed;
      test(Data(static_cast<std::uint64_t>(seed), points, seed % 5), seed % 5);
    }
  }
};

TEST_P(KernelVariant, projects_to_the_same_cells) {
  for_many([](const Data& d, int shift) {
    std::vector<std::int32_t> expected(static_cast<std::size_t>(d.n)), got = expected;
    const int a = kScalarKernels.project(d.x.data() + shift, d.y.data() + shift, d.n, d.view,
                                         expected.data());
    const int b =
        GetParam()->project(d.x.data() + shift, d.y.data() + shift, d.n, d.view, got.data());
    EXPECT_EQ(expected, got);
    EXPECT_EQ(a, b);
  });
}

TEST_P(KernelVariant, projects_through_a_lens_to_the_same_cells) {
  const LensTable lens = some_lens();
  for_many([&](Data d, int shift) {
    for (float& h : d.view.h) h *= 0.02f;
    d.view.h[8] = 1;
    std::vector<std::int32_t> expected(static_cast<std::size_t>(d.n)), got = expected;
    const int a = kScalarKernels.project_lens(d.x.data() + shift, d.y.data() + shift, d.n, d.view,
                                              lens, expected.data());
    const int b = GetParam()->project_lens(d.x.data() + shift, d.y.data() + shift, d.n, d.view,
                                           lens, got.data());
    EXPECT_EQ(expected, got);
    EXPECT_EQ(a, b);
  });
}

TEST_P(KernelVariant, projects_through_a_port_to_the_same_cells) {
  const LensTable lens = some_lens();
  int seen = 0;
  for_many([&](Data d, int shift) {
    std::vector<std::int32_t> expected(static_cast<std::size_t>(d.n)), got = expected;
    const float* const x = d.x.data() + shift;
    const float* const y = d.y.data() + shift;
    int a = kScalarKernels.project_port(x, y, d.n, d.view, expected.data());
    int b = GetParam()->project_port(x, y, d.n, d.view, got.data());
    EXPECT_EQ(expected, got);
    EXPECT_EQ(a, b);
    seen += a;
    for (float& h : d.view.h) h *= 0.02f;
    for (float& n : d.view.port) n *= 0.02f;
    d.view.h[8] = 1;
    a = kScalarKernels.project_port_lens(x, y, d.n, d.view, lens, expected.data());
    b = GetParam()->project_port_lens(x, y, d.n, d.view, lens, got.data());
    EXPECT_EQ(expected, got);
    EXPECT_EQ(a, b);
    seen += a;
  });
  EXPECT_GT(seen, 500);
}

TEST_P(KernelVariant, sums_the_same) {
  for_many([](const Data& d, int shift) {
    std::vector<std::int32_t> index(static_cast<std::size_t>(d.n));
    kScalarKernels.project(d.x.data() + shift, d.y.data() + shift, d.n, d.view, index.data());
    for (const bool all_visible : {false, true}) {
      CorrelationSums expected, got;
      kScalarKernels.correlate(d.cells.data(), index.data(), d.n, d.model.data(), all_visible,
                               expected);
      GetParam()->correlate(d.cells.data(), index.data(), d.n, d.model.data(), all_visible, got);
      EXPECT_TRUE(same_bits(expected, got));
    }
  });
}

TEST_P(KernelVariant, votes_the_same) {
  for_many([](const Data& d, int shift) {
    std::vector<std::int32_t> index(static_cast<std::size_t>(d.n));
    kScalarKernels.project(d.x.data() + shift, d.y.data() + shift, d.n, d.view, index.data());
    const int n_in = d.n / 2 / kLanes * kLanes;
    VoteCounts expected, got;
    kScalarKernels.vote(d.hue_cells.data(), index.data(), n_in, d.n - n_in, d.view.guard,
                        d.hue.data(), d.flags.data(), 250, expected);
    GetParam()->vote(d.hue_cells.data(), index.data(), n_in, d.n - n_in, d.view.guard, d.hue.data(),
                     d.flags.data(), 250, got);
    EXPECT_TRUE(same_bits(expected, got));
  });
}

TEST_P(KernelVariant, compares_the_same) {
  for_many([](const Data& d, int shift) {
    std::vector<std::int32_t> index(static_cast<std::size_t>(d.n));
    kScalarKernels.project(d.x.data() + shift, d.y.data() + shift, d.n, d.view, index.data());
    ProjectionCounts expected, got;
    kScalarKernels.compare(d.hue_cells.data(), index.data(), d.n, d.view.guard,
                           d.hue_value.data() + shift, expected);
    GetParam()->compare(d.hue_cells.data(), index.data(), d.n, d.view.guard,
                        d.hue_value.data() + shift, got);
    EXPECT_TRUE(same_bits(expected, got));
  });
}

INSTANTIATE_TEST_SUITE_P(Here, KernelVariant,
                         testing::ValuesIn(kernels_here().begin(), kernels_here().end()),
                         [](const auto& variant) { return std::string(variant.param->name); });

TEST(ScalarKernels, count_a_hue_half_a_circle_away_as_far) {
  // 0 and 128 are 128 apart: the signed-byte trick would call it −128.
  const std::vector<std::int32_t> index(kLanes, 0);
  const std::uint16_t cells[16] = {128};
  const std::vector<std::uint8_t> hue(kLanes, 0), flags(kLanes, 0);
  VoteCounts counts;
  kScalarKernels.vote(cells, index.data(), kLanes, 0, 99, hue.data(), flags.data(), 0, counts);
  EXPECT_EQ(counts.in_far, kLanes);
  EXPECT_EQ(counts.in_match, 0);
}

TEST(Choice, knows_auto_and_names_and_refuses_others) {
  EXPECT_EQ(find_kernels("auto"), kernels_here().back());
  EXPECT_EQ(find_kernels("scalar"), &kScalarKernels);
  EXPECT_EQ(find_kernels("sse9"), nullptr);
}

}  // namespace
}  // namespace gannet::vision

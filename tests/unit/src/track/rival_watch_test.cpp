#include "src/track/rival_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gannet::track {
namespace {

constexpr std::size_t kGenes = RivalWatch::kGenes;

// The locked pose's peak is the highest, but the watch is for others.
struct Peaks {
  std::array<float, kGenes> own = {0.3f, 0.6f, 0.4f, 0.5f, 0.5f, 0.5f};
  std::array<float, kGenes> other = {0.8f, 0.2f, 0.6f, 0.4f, 0.7f, 0.3f};
  static float peak(std::span<const float> g, const std::array<float, kGenes>& at) {
    float square = 0;
    for (std::size_t k = 0; k < kGenes; ++k) square += (g[k] - at[k]) * (g[k] - at[k]);
    return 1 / (1 + square / 0.09f);
  }
};

class Watch : public testing::Test {
 protected:
  void frame(int count = 160) {
    const auto n = static_cast<std::size_t>(count);
    std::vector<float> genes(n * kGenes), scores(n);
    sut.propose(genes, count);
    for (std::size_t i = 0; i < n; ++i) {
      const std::span<const float> g(genes.data() + i * kGenes, kGenes);
      scores[i] = std::max(Peaks::peak(g, peaks.own), height * Peaks::peak(g, peaks.other));
      for (const float gene : g) EXPECT_TRUE(gene >= 0 && gene <= 1);
    }
    sut.learn(genes, scores, [&](std::size_t i) {
      return std::hypot(genes[i * kGenes] - peaks.own[0], genes[i * kGenes + 1] - peaks.own[1]) <
             0.5f;
    });
  }
  RivalWatch sut;
  Peaks peaks;
  float height = 0.8f;
};

TEST_F(Watch, climbs_the_best_peak_elsewhere_within_some_frames) {
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    sut.reset(seed);
    for (int i = 0; i < 20; ++i) frame();
    found += sut.best_score() > 0.95f * height;
  }
  EXPECT_GE(found, 19);
}

TEST_F(Watch, forgets_what_is_no_longer_there) {
  sut.reset(1);
  for (int i = 0; i < 20; ++i) frame();
  ASSERT_GT(sut.best_score(), 0.6f);
  height = 0.1f;
  frame();
  EXPECT_LT(sut.best_score(), 0.6f);
}

TEST_F(Watch, takes_up_what_it_is_offered) {
  sut.reset(1);
  sut.offer(peaks.other, 0.7f);
  EXPECT_FLOAT_EQ(sut.best_score(), 0.7f);
  frame(RivalWatch::kPlaces);
  EXPECT_NEAR(sut.best_score(), height, 1e-3f);
  sut.reset(1);
  EXPECT_LT(sut.best_score(), -1);
}

}  // namespace
}  // namespace gannet::track

#include "src/world/fitness_maps.hpp"

#include <gtest/gtest.h>

namespace gannet::world {
namespace {

constexpr int kSide = 41;  // ±100 mm

FitnessMap flat_map() {
  FitnessMap map;
  map.width = map.height = kSide;
  map.scores.assign(kSide * kSide, 0.1);
  return map;
}

double& at(FitnessMap& map, int x, int y) {
  return map.scores[static_cast<std::size_t>((y + kSide / 2) * kSide + x + kSide / 2)];
}

TEST(FitnessMaps, the_peak_is_told_from_the_truth_in_the_middle) {
  FitnessMap map = flat_map();
  at(map, 3, -4) = 0.9;
  const MapPeak peak = peak_of(map);
  EXPECT_DOUBLE_EQ(peak.off_mm, 5 * kMapStep_mm);
  EXPECT_DOUBLE_EQ(peak.score, 0.9);
  EXPECT_DOUBLE_EQ(peak.elsewhere, 0.1);
}

TEST(FitnessMaps, a_second_peak_counts_beyond_fifty_millimetres) {
  FitnessMap map = flat_map();
  at(map, 0, 0) = 0.9;
  at(map, 10, 0) = 0.8;  // 50 mm: still the target's own
  at(map, -11, 0) = 0.6;
  EXPECT_DOUBLE_EQ(peak_of(map).off_mm, 0);
  EXPECT_DOUBLE_EQ(peak_of(map).elsewhere, 0.6);
}

TEST(FitnessMaps, a_higher_peak_elsewhere_is_the_peak) {
  FitnessMap map = flat_map();
  at(map, 0, 0) = 0.7;
  at(map, 0, 20) = 0.8;
  EXPECT_DOUBLE_EQ(peak_of(map).off_mm, 20 * kMapStep_mm);
  EXPECT_DOUBLE_EQ(peak_of(map).elsewhere, peak_of(map).score);
}

TEST(FitnessMaps, need_the_album) {
  Serial serial;
  const auto maps = make_fitness_maps("/nowhere/at/all", "none", 1, serial);
  ASSERT_FALSE(maps);
  EXPECT_NE(maps.error().text.find("/nowhere/at/all/models/"), std::string::npos);
}

}  // namespace
}  // namespace gannet::world

#include "src/search/cma_es.hpp"

#include <gtest/gtest.h>

#include "tests/unit/src/search/problems.hpp"

namespace gannet::search {
namespace {

const Problem kProblem{{0.3f, 0.6f, 0.45f, 0.7f, 0.2f, 0.55f}, 0};

TEST(CmaEs, restarts_elsewhere_when_it_has_converged) {
  CmaEs sut(6, {}, 1);
  search(sut, kProblem, 6000);
  EXPECT_GE(sut.restarts(), 2);
  EXPECT_LE(sut.restarts(), 20);
}

TEST(CmaEs, restarts_at_once_on_a_plain) {
  CmaEs sut(6, {}, 1);
  search(
      sut, [](std::span<const float>) { return 0.25f; }, 9 + 18 + 36, 9);
  EXPECT_EQ(sut.restarts(), 3);
}

TEST(CmaEs, a_new_frame_begins_near_the_last_best_or_the_hint) {
  CmaEs sut(6, {}, 1);
  search(sut, kProblem, 1500);
  const std::vector<float> hint = {0.8f, 0.2f, 0.8f, 0.2f, 0.8f, 0.2f};
  for (const std::vector<float>& centre : {kProblem.centre, hint}) {
    sut.begin_frame(centre == hint ? std::span<const float>(hint) : std::span<const float>());
    std::vector<float> seen;
    search(sut, kProblem, 9, 9, &seen);
    for (std::size_t i = 0; i < seen.size(); i += 6) {
      EXPECT_LT(distance(std::span<const float>(seen).subspan(i, 6), centre), 0.25f);
    }
  }
}

TEST(CmaEs, ends_precisely_on_a_smooth_peak) {
  CmaEs sut(6, {}, 3);
  EXPECT_LT(distance(search(sut, kProblem, 1500).genes, kProblem.centre), 1e-3f);
}

TEST(CmaEs, finds_a_peak_on_the_border) {
  const Problem border{{0, 0.5f, 1, 0.5f, 0, 1}, 0};
  CmaEs sut(6, {}, 3);
  EXPECT_LT(distance(search(sut, border, 2500).genes, border.centre), 0.01f);
}

}  // namespace
}  // namespace gannet::search

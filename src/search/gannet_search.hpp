// GannetSearch, our default optimiser: coarse to fine, several hypotheses, the global search always
// on. A frame begins with a quasi-random scan of the whole box on the coarsest level; the best
// places that lie apart become islands, each a small CMA-ES; at every finer level fewer of them go
// on. A hint is an island from the start and is never dropped. Why this and not one population:
// docs/design/search.md. The constructor is start-up only; all else RT safe, one thread.
#pragma once

#include <array>
#include <vector>

#include "src/search/cma_distribution.hpp"
#include "src/search/generational_optimiser.hpp"
#include "src/search/search_config.hpp"

namespace gannet::search {

class GannetSearch final : public GenerationalOptimiser {
 public:
  GannetSearch(int dimension, const GannetSearchConfig& config, std::uint64_t seed);

  void plan(double evaluations, std::span<const double> cost) override;
  void reset(std::uint64_t seed) override;
  void begin_frame(std::span<const float> hint) override;
  int level() const override { return level_; }

 private:
  static constexpr int kMaxLevels = 8;

  struct Island {
    CmaDistribution distribution;
    float score = kNoScore;  // best at the present level
    bool hinted = false;
  };
  struct Place {  // of the scan
    std::array<float, kMaxDimension> genes;
    float score;
  };

  void evolve() override;
  void propose_scan();
  void keep(std::span<const float> genes, float score);
  bool apart(const Place& a, const Place& b) const;
  void found_islands();
  void enter_level(int level);
  void propose_generation();
  void learn_generation();
  void drop_islands();
  double distance(const SmallVector& a, const SmallVector& b) const;
  SmallVector to_vector(std::span<const float> genes) const;

  const GannetSearchConfig config_;
  Random random_;
  // The plan.
  int levels_ = 1;
  int scan_wanted_ = 1000;
  int islands_wanted_ = 8;
  std::array<int, kMaxLevels> generations_ = {};
  // The frame.
  int level_ = 0;
  int scan_done_ = 0;
  std::array<std::uint64_t, kMaxDimension> sequence_ = {};  // of the scan, 64-bit fractions
  std::array<std::uint64_t, kMaxDimension> sequence_step_ = {};
  std::vector<Place> places_;  // best of the scan, best first
  std::vector<Island> islands_;
  int generations_left_ = 0;
  bool scanning_ = true;
  bool has_hint_ = false;
  std::array<float, kMaxDimension> hint_ = {};
  std::vector<SmallVector> steps_;  // of the candidates
};

}  // namespace gannet::search

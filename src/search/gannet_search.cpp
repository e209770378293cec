#include "src/search/gannet_search.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::search {
namespace {

constexpr int kScanBatch = 256;
constexpr int kPlaces = 192;  // of the scan that are remembered
constexpr int kFewestGenerations = 3;
constexpr int kFewestIslands = 3;  // that go on: a coarse level may mistake two peaks

// Steps of the R-sequence in d dimensions (M. Roberts, 2018): powers of the inverse of the root of
// x^(d+1) = x + 1, which spreads points evenly for any number of them.
std::uint64_t sequence_step(int dimension, int k) {
  double root = 1.5;
  for (int i = 0; i < 60; ++i) {
    double power = 1;
    for (int j = 0; j < dimension; ++j) power *= root;
    // Newton on x^(d+1) − x − 1.
    root -= (power * root - root - 1) / ((dimension + 1) * power - 1);
  }
  double step = 1;
  for (int j = 0; j <= k; ++j) step /= root;
  return static_cast<std::uint64_t>(step * 0x1p62) << 2;
}

int island_capacity(const GannetSearchConfig& config) { return config.islands + 1; }

}  // namespace

GannetSearch::GannetSearch(int dimension, const GannetSearchConfig& config, std::uint64_t seed)
    : GenerationalOptimiser(std::max(kScanBatch, island_capacity(config) * config.population),
                            dimension),
      config_(config),
      steps_(static_cast<std::size_t>(island_capacity(config) * config.population)) {
  places_.reserve(kPlaces + 1);
  islands_.reserve(static_cast<std::size_t>(island_capacity(config)));
  const double one = 1;
  plan(5000, {&one, 1});
  reset(seed);
}

void GannetSearch::plan(double evaluations, std::span<const double> cost) {
  levels_ = std::clamp(static_cast<int>(cost.size()), 1, kMaxLevels);
  const auto coarsest = static_cast<std::size_t>(levels_ - 1);
  scan_wanted_ =
      std::max(kScanBatch, static_cast<int>(config_.scan_share * evaluations / cost[coarsest]));
  const double scale = std::min(1.0, evaluations / std::max(config_.evaluations_small, 1.0));
  islands_wanted_ =
      std::max(std::min(4, config_.islands), static_cast<int>(config_.islands * scale));
  const double level_budget = (1 - config_.scan_share) * evaluations / levels_;
  double islands = islands_wanted_ + 1;
  for (std::size_t l = coarsest + 1; l-- > 0;) {
    generations_[l] = std::max(
        kFewestGenerations,
        static_cast<int>(level_budget / (cost[l] * std::ceil(islands) * config_.population)));
    islands = std::max<double>(kFewestIslands, islands * config_.island_share);
  }
}

void GannetSearch::reset(std::uint64_t seed) {
  random_.seed(seed);
  for (std::uint64_t& s : sequence_) s = random_.next();
  for (int k = 0; k < dimension(); ++k) {
    sequence_step_[static_cast<std::size_t>(k)] = sequence_step(dimension(), k);
  }
  forget_best();
  begin_frame({});
}

void GannetSearch::begin_frame(std::span<const float> hint) {
  has_hint_ = !hint.empty();
  copy(hint, hint_);
  forget_best_score();
  places_.clear();
  islands_.clear();
  scan_done_ = 0;
  scanning_ = true;
  level_ = levels_ - 1;
  propose_scan();
}

void GannetSearch::propose_scan() {
  clear_candidates();
  const int n = std::min(kScanBatch, scan_wanted_ - scan_done_);
  for (int i = 0; i < n; ++i) {
    const std::span<float> genes = add_candidate();
    if (has_hint_ && scan_done_ == 0 && i == 0) {
      copy(std::span<const float>(hint_.data(), genes.size()), genes);
      continue;
    }
    for (std::size_t k = 0; k < genes.size(); ++k) {
      sequence_[k] += sequence_step_[k];
      genes[k] = static_cast<float>(sequence_[k] >> 40) * 0x1p-24f;
    }
  }
  scan_done_ += n;
}

void GannetSearch::evolve() {
  if (!scanning_) {
    learn_generation();
    return;
  }
  for (int i = 0; i < candidate_count(); ++i) keep(candidate(i), candidate_score(i));
  if (scan_done_ < scan_wanted_) {
    propose_scan();
    return;
  }
  scanning_ = false;
  found_islands();
  enter_level(level_);
}

// Insertion into the sorted list of the best places; equal scores stay in their order.
void GannetSearch::keep(std::span<const float> genes, float score) {
  if (places_.size() == kPlaces && score <= places_.back().score) return;
  Place place = {{}, score};
  copy(genes, place.genes);
  const auto at =
      std::upper_bound(places_.begin(), places_.end(), score,
                       [](float value, const Place& other) { return value > other.score; });
  places_.insert(at, place);
  if (places_.size() > kPlaces) places_.pop_back();
}

bool GannetSearch::apart(const Place& a, const Place& b) const {
  float square = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension()); ++i) {
    const float d = a.genes[i] - b.genes[i];
    square += d * d;
  }
  const auto least = static_cast<float>(config_.apart);
  return square >= least * least;
}

SmallVector GannetSearch::to_vector(std::span<const float> genes) const {
  SmallVector v = {};
  for (std::size_t i = 0; i < genes.size(); ++i) v[i] = static_cast<double>(genes[i]);
  return v;
}

void GannetSearch::found_islands() {
  const auto add = [this](std::span<const float> genes, double sigma, bool hinted) {
    Island island = {CmaDistribution(dimension()), kNoScore, hinted};
    island.distribution.start(to_vector(genes), sigma, config_.population);
    islands_.push_back(island);
  };
  const auto n = static_cast<std::size_t>(dimension());
  if (has_hint_) add({hint_.data(), n}, config_.sigma_hint, true);
  std::array<std::size_t, 64> chosen;
  std::size_t count = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (count == static_cast<std::size_t>(islands_wanted_)) break;
    const bool is_new =
        std::all_of(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](std::size_t k) { return apart(places_[i], places_[k]); });
    if (!is_new) continue;
    chosen[count++] = i;
    add({places_[i].genes.data(), n}, config_.sigma_scan, false);
  }
}

void GannetSearch::enter_level(int level) {
  level_ = level;
  generations_left_ = generations_[static_cast<std::size_t>(level)];
  forget_best_score();  // scores of another level are not comparable
  for (Island& island : islands_) island.score = kNoScore;
  propose_generation();
}

void GannetSearch::propose_generation() {
  clear_candidates();
  std::size_t at = 0;
  for (const Island& island : islands_) {
    const CmaDistribution& d = island.distribution;
    for (int k = 0; k < config_.population; ++k) {
      // The first sample of a level is the mean itself.
      SmallVector& step = steps_[at++];
      step = k == 0 && island.score == kNoScore ? SmallVector{} : d.draw_step(random_);
      const std::span<float> genes = add_candidate();
      for (std::size_t i = 0; i < genes.size(); ++i) {
        genes[i] = fold(static_cast<float>(d.mean()[i] + d.sigma() * step[i]));
      }
    }
  }
}

void GannetSearch::learn_generation() {
  for (std::size_t m = 0; m < islands_.size(); ++m) {
    Island& island = islands_[m];
    const int first = static_cast<int>(m) * config_.population;
    std::array<int, 64> order;
    for (int k = 0; k < config_.population; ++k) order[static_cast<std::size_t>(k)] = first + k;
    const auto end = order.begin() + config_.population;
    std::sort(order.begin(), end, [this](int a, int b) {
      return candidate_score(a) != candidate_score(b) ? candidate_score(a) > candidate_score(b)
                                                      : a < b;
    });
    island.score = std::max(island.score, candidate_score(order[0]));
    island.distribution.adapt([&](int k) -> const SmallVector& {
      return steps_[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])];
    });
  }
  if (--generations_left_ > 0 || level_ == 0) {
    propose_generation();
    return;
  }
  drop_islands();
  enter_level(level_ - 1);
}

// Keeps the best share of the islands, but of those that have climbed the same peak only the best:
// a false peak that looks high on a coarse level would otherwise crowd out the true one.
void GannetSearch::drop_islands() {
  std::sort(islands_.begin(), islands_.end(), [](const Island& a, const Island& b) {
    return a.hinted != b.hinted ? a.hinted : a.score > b.score;
  });
  const double share = static_cast<double>(islands_.size()) * config_.island_share;
  const auto wanted =
      std::max<std::size_t>(kFewestIslands, static_cast<std::size_t>(std::ceil(share)));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < islands_.size() && kept < wanted; ++i) {
    const auto same_peak = [&](const Island& other) {
      return distance(islands_[i].distribution.mean(), other.distribution.mean()) <
             0.5 * config_.apart;
    };
    const auto end = islands_.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::any_of(islands_.begin(), end, same_peak)) continue;
    if (kept != i) islands_[kept] = islands_[i];
    ++kept;
  }
  islands_.erase(islands_.begin() + static_cast<std::ptrdiff_t>(kept), islands_.end());
}

double GannetSearch::distance(const SmallVector& a, const SmallVector& b) const {
  double square = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension()); ++i) {
    square += (a[i] - b[i]) * (a[i] - b[i]);
  }
  return std::sqrt(square);
}

}  // namespace gannet::search

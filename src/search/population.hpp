// Population: a fixed number of gene vectors with scores, and the helpers that all optimisers
// share. Genes are in [0, 1]; larger scores are better, and only their order is ever used. Memory
// is taken by the constructor (start-up only); all else is RT safe. Owned by one optimiser.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet::search {

constexpr int kMaxDimension = 8;
constexpr float kNoScore = -std::numeric_limits<float>::infinity();

class Population {
 public:
  Population(int capacity, int dimension);

  int capacity() const { return capacity_; }
  int dimension() const { return dimension_; }
  std::span<float> genes(int i) { return {row(i), static_cast<std::size_t>(dimension_)}; }
  std::span<const float> genes(int i) const {
    return {row(i), static_cast<std::size_t>(dimension_)};
  }
  float score(int i) const { return scores_[static_cast<std::size_t>(i)]; }
  void set_score(int i, float score) { scores_[static_cast<std::size_t>(i)] = score; }

  // Sorts the first count by score, best first, equals by index, so that the order is the same
  // everywhere.
  void rank(int count);
  void rank() { rank(capacity_); }
  // Index of the k-th best as of the last rank().
  int ranked(int k) const { return order_[static_cast<std::size_t>(k)]; }

 private:
  float* row(int i) { return data_.data() + static_cast<std::size_t>(i * dimension_); }
  const float* row(int i) const { return data_.data() + static_cast<std::size_t>(i * dimension_); }

  int capacity_;
  int dimension_;
  std::vector<float> data_;
  std::vector<float> scores_;
  std::vector<int> order_;
};

// Mirrors a coordinate at 0 and 1 until it lies in [0, 1]. A mirror, unlike a clamp, does not heap
// candidates up on the border; what is not finite becomes ½.
float fold(float x);

void copy(std::span<const float> from, std::span<float> to);
void draw_anywhere(Random& random, std::span<float> genes);
// Uniform in a cube of half-width radius about centre, folded.
void draw_near(Random& random, std::span<const float> centre, float radius, std::span<float> genes);

}  // namespace gannet::search

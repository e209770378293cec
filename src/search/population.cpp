#include "src/search/population.hpp"

#include <algorithm>
#include <cassert>

namespace gannet::search {

Population::Population(int capacity, int dimension)
    : capacity_(capacity),
      dimension_(dimension),
      data_(static_cast<std::size_t>(capacity * dimension), 0.5f),
      scores_(static_cast<std::size_t>(capacity), kNoScore),
      order_(static_cast<std::size_t>(capacity)) {
  rank();
}

void Population::rank(int count) {
  for (int i = 0; i < count; ++i) order_[static_cast<std::size_t>(i)] = i;
  std::sort(order_.begin(), order_.begin() + count,
            [this](int a, int b) { return score(a) != score(b) ? score(a) > score(b) : a < b; });
}

float fold(float x) {
  if (!(x > -1e6f && x < 1e6f)) return 0.5f;
  if (x < 0) x = -x;
  // Conversion to int truncates: the number of whole widths passed.
  const int widths = static_cast<int>(x);
  const float rest = x - static_cast<float>(widths);
  return widths % 2 == 0 ? rest : 1.0f - rest;
}

void copy(std::span<const float> from, std::span<float> to) {
  assert(from.size() <= to.size());
  std::copy(from.begin(), from.end(), to.begin());
}

void draw_anywhere(Random& random, std::span<float> genes) {
  for (float& g : genes) g = random.uniform_f();
}

void draw_near(Random& random, std::span<const float> centre, float radius,
               std::span<float> genes) {
  for (std::size_t i = 0; i < genes.size(); ++i) {
    genes[i] = fold(centre[i] + radius * (2 * random.uniform_f() - 1));
  }
}

}  // namespace gannet::search

// Problems with a known answer, and a loop that plays one frame of a search. Test support.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "src/search/optimiser.hpp"

namespace gannet::search {

// Peak 1 at centre.
struct Problem {
  std::vector<float> centre;
  float ripple = 0;  // height of the false peaks
  float operator()(std::span<const float> genes) const {
    double square = 0;
    double waves = 0;
    for (std::size_t i = 0; i < genes.size(); ++i) {
      const double d = static_cast<double>(genes[i] - centre[i]);
      square += d * d;
      waves += 1 - std::cos(2 * 3.14159265358979 * 8 * d);
    }
    return static_cast<float>(1 - 4 * square - static_cast<double>(ripple) * waves);
  }
};

// A narrow ridge that lies askew to all axes: what a learnt covariance is for.
struct Ridge {
  std::vector<float> centre;
  float operator()(std::span<const float> genes) const {
    double sum = 0;
    double square = 0;
    for (std::size_t i = 0; i < genes.size(); ++i) {
      const double d = static_cast<double>(genes[i] - centre[i]);
      sum += (i % 2 == 0 ? 1 : -1) * d;
      square += d * d;
    }
    return static_cast<float>(-square - 300 * sum * sum);
  }
};

inline float distance(std::span<const float> a, std::span<const float> b) {
  float most = 0;
  for (std::size_t i = 0; i < b.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

struct Answer {
  std::vector<float> genes;
  float score = 0;
};

// Scores `evaluations` candidates, `portion` at a time. `seen`, if given, gathers them all.
template <class Score>
Answer search(Optimiser& sut, Score&& score, int evaluations, int portion = 64,
              std::vector<float>* seen = nullptr) {
  const std::size_t n = static_cast<std::size_t>(sut.dimension());
  std::vector<float> genes(n * static_cast<std::size_t>(portion));
  std::vector<float> scores(static_cast<std::size_t>(portion));
  while (evaluations > 0) {
    const std::size_t room = static_cast<std::size_t>(std::min(portion, evaluations));
    const std::size_t count =
        static_cast<std::size_t>(sut.propose(std::span(genes).first(room * n)));
    for (std::size_t i = 0; i < count; ++i) {
      scores[i] = score(std::span<const float>(genes).subspan(i * n, n));
    }
    if (seen)
      seen->insert(seen->end(), genes.begin(), genes.begin() + static_cast<long>(count * n));
    sut.learn(std::span<const float>(scores).first(count));
    evaluations -= static_cast<int>(count);
  }
  Answer answer{std::vector<float>(n), 0};
  answer.score = sut.best(answer.genes);
  return answer;
}

}  // namespace gannet::search

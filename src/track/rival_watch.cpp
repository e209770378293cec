#include "src/track/rival_watch.hpp"

#include <algorithm>

namespace gannet::track {
namespace {

constexpr std::size_t kClimbers = 3;  // candidates a frame that climb from each place
constexpr float kApart = 0.12f;       // least distance of two places, as a share of the ranges
constexpr float kReach = 0.06f, kLeastReach = 0.01f, kMostReach = 0.1f;

float square_distance(std::span<const float> a, std::span<const float> b) {
  float sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

}  // namespace

void RivalWatch::reset(std::uint64_t seed) {
  random_.seed(seed);
  places_.fill({});
}

std::size_t RivalWatch::best_at() const {
  const auto best =
      std::max_element(places_.begin(), places_.end(),
                       [](const Place& a, const Place& b) { return a.score < b.score; });
  return static_cast<std::size_t>(best - places_.begin());
}

// In place of a worse one nearby, or of the worst one of all.
void RivalWatch::offer(std::span<const float> genes, float score) {
  Place* worst = &places_[0];
  for (Place& place : places_) {
    if (place.score > kNone && square_distance(place.genes, genes) < kApart * kApart) {
      worst = &place;
      break;
    }
    if (place.score < worst->score) worst = &place;
  }
  if (score <= worst->score) return;
  std::copy_n(genes.begin(), kGenes, worst->genes.begin());
  worst->score = score;
  worst->reach = kReach;
}

void RivalWatch::propose(std::span<float> genes, int count) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::span<float> to = genes.subspan(i * kGenes, kGenes);
    const Place& place = places_[i % kPlaces];
    const bool has_place = place.score > kNone;
    if (i < kPlaces && has_place) {
      std::copy(place.genes.begin(), place.genes.end(), to.begin());
    } else if (i < kPlaces * (1 + kClimbers) && has_place) {
      for (std::size_t k = 0; k < kGenes; ++k) {
        to[k] = std::clamp(place.genes[k] + place.reach * random_.normal_f(), 0.0f, 1.0f);
      }
    } else {
      for (float& gene : to) gene = random_.uniform_f();
    }
  }
}

void RivalWatch::learn_one(std::size_t i, std::span<const float> genes, float score) {
  Place& place = places_[i % kPlaces];
  if (i < kPlaces) {
    if (place.score > kNone) place.score = score;
    if (place.score <= kNone) offer(genes, score);
    return;
  }
  if (i >= kPlaces * (1 + kClimbers) || place.score <= kNone) {
    if (score > kNone) offer(genes, score);
    return;
  }
  // Steps grow where they succeed and shrink where they fail.
  if (score > place.score) {
    std::copy(genes.begin(), genes.end(), place.genes.begin());
    place.score = score;
    place.reach = std::min(kMostReach, 1.5f * place.reach);
  } else {
    place.reach = std::max(kLeastReach, 0.9f * place.reach);
  }
}

}  // namespace gannet::track

// Optimiser: proposes gene vectors and learns their scores. It knows neither pixels nor threads
// nor time: the caller decides how many rounds there are. Genes are in [0, 1]; larger scores are
// better. Created at start-up by make_optimiser (optimiser_kinds.hpp); propose and learn are RT
// safe (no heap after creation) and belong to one thread.
#pragma once

#include <cstdint>
#include <span>

namespace gannet::search {

class Optimiser {
 public:
  virtual ~Optimiser() = default;

  virtual int dimension() const = 0;

  // Forgets everything and starts from nothing with this seed.
  virtual void reset(std::uint64_t seed) = 0;

  // What the coming frames may cost, in full evaluations, and what one costs at each level of
  // detail (cost[0] = 1). Optimisers that know no levels need not care.
  virtual void plan(double evaluations, std::span<const double> cost) {
    static_cast<void>(evaluations);
    static_cast<void>(cost);
  }

  // A new frame: scores learnt before are stale. Persistent populations keep their members and
  // expect them to be scored again; hint (empty or of dimension() genes) is the predicted answer.
  virtual void begin_frame(std::span<const float> hint) = 0;

  // Writes the next candidates, dimension() genes each, one after the other; returns how many
  // (at most genes.size() / dimension(), at least 1).
  virtual int propose(std::span<float> genes) = 0;

  // How finely the candidates of the last propose want to be scored: 0 is the full model on the
  // full images, each step up a coarser one. Optimisers that know no levels leave it at 0.
  virtual int level() const { return 0; }

  // The scores of the candidates of the last propose, in their order.
  virtual void learn(std::span<const float> scores) = 0;

  // The best of this frame so far; genes of dimension() size. Score is −infinity before any.
  virtual float best(std::span<float> genes) const = 0;
};

}  // namespace gannet::search

#include "src/track/model_search.hpp"

#include <algorithm>
#include <string>

namespace gannet::track {

Result<std::unique_ptr<ModelSearch>> ModelSearch::create(const TrackConfig& config,
                                                         const StereoRig& rig,
                                                         std::vector<vision::PatchModel> models,
                                                         int max_workers,
                                                         std::string_view kernels) {
  if (models.empty()) return Error{"there is no model to search for"};
  if (models.size() > kMostModels)
    return Error{"there are more than " + std::to_string(kMostModels) + " models"};
  for (const vision::PatchModel& model : models)
    if (model.points.size() > static_cast<std::size_t>(Recogniser::max_points()))
      return Error{"model " + model.name + " has too many points"};
  auto recogniser = Recogniser::create(config, rig, TargetKind::kModel, max_workers, kernels);
  if (!recogniser) return recogniser.error();
  return std::unique_ptr<ModelSearch>(
      new ModelSearch(config, std::move(models), std::move(*recogniser)));
}

void ModelSearch::restart() {
  tried_ = 0;
  searched_ = 0;
  fitness_.fill(-1);
}

Recognition ModelSearch::search(int model, const vision::PreparedFrame& frame, double evaluations,
                                Parallel& parallel) {
  recogniser_->set_model(models_[static_cast<std::size_t>(model)]);
  Recognition seen = recogniser_->recognise(frame, nullptr, {.evaluations = evaluations}, parallel);
  fitness_[static_cast<std::size_t>(model)] = seen.fitness;
  return seen;
}

void ModelSearch::choose_finalists() {
  std::array<int, kMostModels> order = {};
  for (int i = 0; i < models(); ++i) order[static_cast<std::size_t>(i)] = i;
  const auto better = [this](int a, int b) {
    const double of_a = fitness_[static_cast<std::size_t>(a)];
    const double of_b = fitness_[static_cast<std::size_t>(b)];
    return of_a > of_b || (of_a == of_b && a < b);
  };
  std::partial_sort(order.begin(), order.begin() + finals(), order.begin() + models(), better);
  std::copy_n(order.begin(), finals(), finalists_.begin());
}

// What the finalists scored in full against all others.
ModelSearch::Answer ModelSearch::judge() const {
  Answer out;
  out.done = true;
  int at = 0;
  const auto fitness_of = [this](int model) { return fitness_[static_cast<std::size_t>(model)]; };
  for (int i = 1; i < finals(); ++i)
    if (fitness_of(finalists_[static_cast<std::size_t>(i)]) >
        fitness_of(finalists_[static_cast<std::size_t>(at)]))
      at = i;
  out.best = finalists_[static_cast<std::size_t>(at)];
  out.fitness = fitness_of(out.best);
  double second = -1;
  for (int i = 0; i < models(); ++i)
    if (i != out.best) second = std::max(second, fitness_of(i));
  out.ahead = out.fitness - second;
  const Recognition& seen = seen_[static_cast<std::size_t>(at)];
  if (!seen.found || out.ahead < kAhead) return out;
  out.model = out.best;
  out.seen = seen;
  return out;
}

ModelSearch::Answer ModelSearch::look(const vision::PreparedFrame& frame, double evaluations,
                                      Parallel& parallel) {
  const double wanted = evaluations > 0 ? evaluations : config_.evaluations;
  if (tried_ < models()) {
    const int count = std::min(kAFrame, models() - tried_);
    for (int i = 0; i < count; ++i) search(tried_++, frame, wanted / count, parallel);
    if (tried_ == models()) choose_finalists();
    return {};
  }
  const auto at = static_cast<std::size_t>(searched_++);
  seen_[at] = search(finalists_[at], frame, wanted, parallel);
  if (searched_ < finals()) return {};
  const Answer answer = judge();
  restart();
  return answer;
}

}  // namespace gannet::track

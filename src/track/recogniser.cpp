#include "src/track/recogniser.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "src/search/optimiser_kinds.hpp"
#include "src/vision/fitness_kinds.hpp"
#include "src/vision/hue_value.hpp"
#include "src/vision/kernel_choice.hpp"
#include "src/vision/likeness.hpp"

namespace gannet::track {
namespace {

constexpr int kBatch = 512;         // candidates a round
constexpr int kChunk = 16;          // of them a piece of parallel work
constexpr double kLeastSizePx = 9;  // of the target on a coarse level, √area
constexpr double kSpacingPx = 1.8;  // of a coarse level's points, in that level's pixels
// At least so many of the model's spacings: a level that costs as much as a finer one saves
// nothing.
constexpr double kLeastMerge = 1.6;
constexpr double kRectanglePoints = 1500;
constexpr int kPlaceCandidates = 24;  // of place(), about the hint
constexpr int kTilts = 5;             // of try_tilts(), about each axis
constexpr int kTiltAnswers = 2;       // of them finished
constexpr double kLeadCounts = 0.5;   // of the lead on the coarsest level, as likeness
// Share of the likeness that suffices where the target was a frame ago: there the best wrong pose
// is one of few.
constexpr double kKeep = 0.7;

double radians(double degrees) { return degrees * 3.14159265358979323846 / 180; }

// What a rectangle's rays come from, in the left camera's frame: its centre, or its port's pupil.
Eigen::Vector3d eye_of(const StereoRig& rig, TargetKind kind) {
  return kind == TargetKind::kRectangle ? rig.left.pupil() : Eigen::Vector3d::Zero();
}

// The rig with the left frame's origin moved.
StereoRig seen_from(StereoRig rig, const Eigen::Vector3d& eye) {
  rig.right_from_left.translation = rig.right_from_left(eye);
  return rig;
}

SearchVolume volume_of(const TrackConfig& c, const Eigen::Vector3d& eye) {
  return {c.z_min_m - eye.z(), c.z_max_m - eye.z(), c.half_width_x_m,
          c.half_width_y_m,    radians(c.tilt_deg), radians(c.roll_deg)};
}

// Of a pose that is the search's own: about the median errors of the papers' votes, which have no
// residuals to tell more by (20 mm along the view, 15°).
Matrix6d search_covariance() {
  Vector6d sigma;
  sigma << 0.005, 0.005, 0.02, 0.26, 0.26, 0.26;
  return sigma.cwiseAbs2().asDiagonal();
}

// How far a pose is from the one whose covariance it is given, as a covariance.
Matrix6d spread(const Transform<LeftCamera, Target>& pose,
                const Transform<LeftCamera, Target>& measured) {
  const Eigen::AngleAxisd turn(measured.rotation * pose.rotation.conjugate());
  Eigen::Matrix<double, 6, 1> apart;
  apart << measured.translation - pose.translation, turn.angle() * turn.axis();
  return apart * apart.transpose();
}

}  // namespace

Recogniser::Recogniser(const TrackConfig& config, const StereoRig& rig, TargetKind kind,
                       int max_workers)
    : config_(config),
      eye_(eye_of(rig, kind)),
      optics_(eye_.isZero() ? rig : seen_from(rig, eye_)),
      rig_(optics_.rig),
      kind_(kind),
      space_(rig, volume_of(config, eye_)),
      relief_(kind == TargetKind::kModel && config.relief ? max_points() : 0),
      genes_(kBatch * 8),
      hypotheses_(kBatch),
      scores_(kBatch) {
  rivals_.resize(kRivalCells * kRivalCells);
  const auto n = static_cast<std::size_t>(max_points());
  points_.reserve(n);
  coarse_.reserve(n);
  for (vision::PointSet& level : target_.level) level.reserve(max_points());
  for (int w = 0; w < max_workers; ++w) scratch_.emplace_back(max_points());
  target_.unscaled = kind == TargetKind::kRectangle;
  if (target_.unscaled) space_.fix_ray(Eigen::Vector3d::UnitZ());
}

Result<std::unique_ptr<Recogniser>> Recogniser::create(const TrackConfig& config,
                                                       const StereoRig& rig, TargetKind kind,
                                                       int max_workers, std::string_view kernels) {
  const vision::Kernels* chosen = vision::find_kernels(kernels);
  if (chosen == nullptr) {
    return Error{"no kernels \"" + std::string(kernels) + "\" on this processor"};
  }
  if (!(config.z_min_m > 0) || !(config.z_max_m > config.z_min_m)) {
    return Error{"the search range in z must be positive and increasing"};
  }
  std::unique_ptr<Recogniser> made(new Recogniser(config, rig, kind, max_workers));
  auto fitness =
      vision::make_fitness(config.fitness, kind == TargetKind::kRectangle, made->rig_, *chosen);
  if (!fitness) return fitness.error();
  made->fitness_ = std::move(*fitness);
  auto optimiser = search::make_optimiser(config.optimiser, made->space_.dimension(), config.search,
                                          static_cast<std::uint64_t>(config.seed));
  if (!optimiser) return optimiser.error();
  made->optimiser_ = std::move(*optimiser);
  return made;
}

vision::PlaneNeeds Recogniser::needs() const {
  // The refinement samples smoothed bytes, which every frame has.
  return fitness_->needs();
}

// Levels on which the target is still large enough to be told from others.
bool Recogniser::assign_levels(double projected_size_px, double spacing_px) {
  if (points_.size() > static_cast<std::size_t>(max_points())) return false;
  target_.levels = 1;
  while (target_.levels < vision::kLevels &&
         projected_size_px / (1 << target_.levels) >= kLeastSizePx) {
    ++target_.levels;
  }
  for (int l = 0; l < target_.levels; ++l) {
    const double factor = l == 0 ? 1 : std::max(kLeastMerge, kSpacingPx * (1 << l) / spacing_px);
    vision::coarsen(points_, spacing_, factor, coarse_);
    target_.level[static_cast<std::size_t>(l)].assign(coarse_, background_, target_.background_hue,
                                                      target_.unscaled);
  }
  std::array<double, vision::kLevels> cost = {};
  const int levels = fitness_->levels(target_);
  for (int l = 0; l < levels; ++l) cost[static_cast<std::size_t>(l)] = target_.cost(l);
  optimiser_->plan(config_.evaluations, {cost.data(), static_cast<std::size_t>(levels)});
  watch_.reset(static_cast<std::uint64_t>(config_.seed));
  watch_is_seeded_ = false;
  random_.seed(static_cast<std::uint64_t>(config_.seed));
  low_m_.setConstant(std::numeric_limits<double>::infinity());
  high_m_ = -low_m_;
  for (const vision::ModelPoint& p : points_) {
    const Eigen::Vector2d at(static_cast<double>(p.x_m), static_cast<double>(p.y_m));
    low_m_ = low_m_.cwiseMin(at);
    high_m_ = high_m_.cwiseMax(at);
  }
  has_target_ = true;
  return true;
}

bool Recogniser::set_model(const vision::PatchModel& model) {
  if (model.points.size() > static_cast<std::size_t>(max_points())) return false;
  points_ = model.points;
  background_ = model.background;
  target_.background_hue = model.background_hue;
  spacing_ = model.spacing_m;
  size_m_ = model.size_m;
  const double f = rig_.left.magnification().x();
  const double area = model.spacing_m * model.spacing_m * model.inside_count;
  const double middle = std::sqrt(config_.z_min_m * config_.z_max_m);
  optimiser_->reset(static_cast<std::uint64_t>(config_.seed));
  if (!assign_levels(std::sqrt(area) * f / config_.z_max_m, spacing_ * f / middle)) return false;
  if (config_.relief) relief_.reset(target_.level[0], spacing_, model.eye_m);
  return true;
}

bool Recogniser::set_rectangle(const vision::Rectangle& r, const vision::PreparedFrame& frame) {
  if (!refresh_rectangle(r, frame)) return false;
  optimiser_->reset(static_cast<std::uint64_t>(config_.seed));
  return true;
}

bool Recogniser::refresh_rectangle(const vision::Rectangle& r, const vision::PreparedFrame& frame) {
  const vision::EyePlanes& eye = frame.left();
  const bool fits = r.width >= 8 && r.height >= 8 && r.x >= 0 && r.y >= 0 && r.width <= eye.width &&
                    r.height <= eye.height && r.x <= eye.width - r.width &&
                    r.y <= eye.height - r.height;
  if (!fits || kind_ != TargetKind::kRectangle) return false;
  rectangle_ = r;
  const double area = static_cast<double>(r.width) * r.height;
  const int step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kRectanglePoints))));
  const int band = std::max(step, static_cast<int>(0.15 * std::sqrt(area)));
  const Eigen::Vector2d centre(r.x + (r.width - 1) / 2.0, r.y + (r.height - 1) / 2.0);
  aim_ = level_aim_ = {0, 0, 1 / std::sqrt(config_.z_min_m * config_.z_max_m)};
  centre_ray_ = ray_of(centre, aim_);
  space_.fix_ray(centre_ray_);
  points_.clear();
  // S_out is Pb3DP's; the correlation goes without: what is beside the patch may lie elsewhere.
  const bool with_band = !fitness_->needs().packed;
  for (const bool inside : {true, false}) {
    if (!inside && !with_band) break;
    const int margin = inside ? 0 : band;
    for (int y = r.y + step / 2 - margin / step * step; y < r.y + r.height + margin; y += step) {
      for (int x = r.x + step / 2 - margin / step * step; x < r.x + r.width + margin; x += step) {
        if (x < 0 || y < 0 || x >= eye.width || y >= eye.height) continue;
        const bool in_rectangle = x >= r.x && y >= r.y && x < r.x + r.width && y < r.y + r.height;
        if (in_rectangle != inside || points_.size() >= points_.capacity()) continue;
        const Eigen::Vector3d ray = ray_of({x, y}, aim_);
        const auto at = static_cast<std::size_t>(y * eye.width + x);
        points_.push_back(
            {static_cast<float>(ray.x()),
             static_cast<float>(ray.y()),
             inside,
             {static_cast<float>(eye.smooth[0][at]), static_cast<float>(eye.smooth[1][at]),
              static_cast<float>(eye.smooth[2][at])}});
      }
    }
  }
  spacing_ = step / rig_.left.magnification().x();
  return assign_levels(std::sqrt(area), step);
}

void Recogniser::note_rivals(int n) {
  const auto dimension = static_cast<std::size_t>(space_.dimension());
  const auto cell = [](float gene) {
    return std::min(kRivalCells - 1, static_cast<int>(gene * kRivalCells));
  };
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    const float* g = genes_.data() + i * dimension;
    const int at = cell(g[0]) + (dimension == 6 ? kRivalCells * cell(g[1]) : 0);
    Rival& rival = rivals_[static_cast<std::size_t>(at)];
    if (scores_[i] <= rival.score) continue;
    rival = {scores_[i], hypotheses_[i].translation, {}};
    std::copy_n(g, dimension, rival.genes.begin());
  }
}

// Farther away than half of what the target is large, or than a share of its distance along the
// view.
bool Recogniser::elsewhere(const std::array<double, 3>& place,
                           const vision::Hypothesis& answer) const {
  const double apart = target_.unscaled ? 0.0 : 0.5 * size_m_.maxCoeff();
  const double dx = place[0] - answer.translation[0];
  const double dy = place[1] - answer.translation[1];
  const double dz = std::abs(place[2] - answer.translation[2]);
  return target_.unscaled ? dz > 0.15 * answer.translation[2] : dx * dx + dy * dy > apart * apart;
}

float Recogniser::best_rival(const vision::Hypothesis& answer) const {
  float best = -1;
  for (const Rival& r : rivals_) {
    if (r.score > best && elsewhere(r.translation, answer)) best = r.score;
  }
  return best;
}

float Recogniser::score_one(const vision::PreparedFrame& frame, int level,
                            const vision::Hypothesis& q) {
  float score = 0;
  fitness_->score(target_, frame, level, {&q, 1}, {&score, 1}, scratch_[0]);
  return score;
}

void Recogniser::score_batch(const vision::PreparedFrame& frame, int level, int n,
                             Parallel& parallel) {
  const int dimension = space_.dimension();
  parallel.for_each((n + kChunk - 1) / kChunk, [&](int chunk, int worker) {
    const int first = chunk * kChunk;
    const auto count = static_cast<std::size_t>(std::min(kChunk, n - first));
    const auto at = static_cast<std::size_t>(first);
    for (std::size_t i = 0; i < count; ++i) {
      hypotheses_[at + i] =
          space_.decode({genes_.data() + (at + i) * static_cast<std::size_t>(dimension),
                         static_cast<std::size_t>(dimension)});
    }
    fitness_->score(target_, frame, level, {hypotheses_.data() + at, count},
                    {scores_.data() + at, count}, scratch_[static_cast<std::size_t>(worker)]);
  });
}

Recognition Recogniser::recognise(const vision::PreparedFrame& frame,
                                  const Transform<LeftCamera, Target>* hint, const Budget& budget,
                                  Parallel& parallel) {
  Recognition none;
  none.reason = TrackReason::kNoTarget;
  if (!has_target_) return none;
  const auto dimension = static_cast<std::size_t>(space_.dimension());
  const double wanted = budget.evaluations > 0 ? budget.evaluations : config_.evaluations;
  const int levels = fitness_->levels(target_);
  std::array<double, vision::kLevels> cost = {};
  for (int l = 0; l < levels; ++l) cost[static_cast<std::size_t>(l)] = target_.cost(l);
  optimiser_->plan(wanted, {cost.data(), static_cast<std::size_t>(levels)});

  watch_is_seeded_ = false;  // by what this search comes across
  std::array<float, 8> best = {};
  if (hint != nullptr) {
    space_.encode({hint->rotation, hint->translation - eye_}, best);
  }
  optimiser_->begin_frame({best.data(), hint != nullptr ? dimension : 0});
  std::fill(rivals_.begin(), rivals_.end(), Rival{-1, {}, {}});
  double spent = 0;
  // The answer is scored four times more: found, refined, on the coarsest level, eye by eye.
  // A small search has nothing left for looking at all other tilts, or at any.
  constexpr double kTiltsShare = 0.2;
  double for_tilts = can_follow() ? tilts_cost(kTilts * kTilts, kTiltAnswers) : wanted;
  const bool all_tilts = for_tilts <= kTiltsShare * wanted;
  if (!all_tilts && can_follow()) for_tilts = tilts_cost(3, 1);
  const bool with_tilts = for_tilts <= kTiltsShare * wanted;
  const double for_search = std::max(wanted - 4 - (with_tilts ? for_tilts : 0), 1.0);
  while (spent < for_search) {
    if (budget.stop != nullptr && budget.stop(budget.context)) break;
    const int level = std::min(optimiser_->level(), levels - 1);
    const double one = target_.cost(level);
    if (spent > 0 && for_search - spent < one) break;
    const auto room = std::min<std::size_t>(
        kBatch, static_cast<std::size_t>(std::max(1.0, std::floor((for_search - spent) / one))));
    const int n = optimiser_->propose({genes_.data(), room * dimension});
    score_batch(frame, level, n, parallel);
    if (level == levels - 1) note_rivals(n);
    optimiser_->learn({scores_.data(), static_cast<std::size_t>(n)});
    spent += n * one;
  }
  optimiser_->best(best);
  const vision::Hypothesis answer = space_.decode({best.data(), dimension});
  float score = 0;
  fitness_->score(target_, frame, 0, {&answer, 1}, {&score, 1}, scratch_[0]);
  Recognition out = finish(frame, answer, score, spent + 1);
  if (with_tilts) try_tilts(frame, all_tilts, out);
  return out;
}

bool Recogniser::can_follow() const {
  return has_target_ && !target_.unscaled && fitness_->levels(target_) > 1 &&
         fitness_->needs().packed && config_.optimiser == "gannet";
}

// The best of some candidates about the hint, then refined on coarse pixels, which reach far.
Transform<LeftCamera, Target> Recogniser::place(const vision::PreparedFrame& frame,
                                                const Transform<LeftCamera, Target>& hint,
                                                Parallel& parallel) {
  constexpr std::array<float, 6> kReach = {0.02f, 0.02f, 0.03f, 0.05f, 0.05f, 0.05f};
  const int level = coarse_level();
  std::array<float, 8> genes = {};
  space_.encode(hint, genes);
  for (std::size_t i = 0; i < static_cast<std::size_t>(kPlaceCandidates); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      const float off = i == 0 ? 0 : kReach[k] * random_.normal_f();
      genes_[i * 6 + k] = std::clamp(genes[k] + off, 0.0f, 1.0f);
    }
  }
  score_batch(frame, level, kPlaceCandidates, parallel);
  const auto best = std::max_element(scores_.begin(), scores_.begin() + kPlaceCandidates);
  const vision::Hypothesis& start = hypotheses_[static_cast<std::size_t>(best - scores_.begin())];
  vision::RefineOptions options;
  options.level = level;
  options.iterations = 5;
  const vision::PointSet& points = target_.level[static_cast<std::size_t>(level)];
  const vision::Refinement refined =
      vision::refine_pose(optics_, points, frame, start.pose(), options);
  const vision::Hypothesis answer = vision::Hypothesis::from(refined.left_from_target);
  return score_one(frame, level, answer) >= *best ? refined.left_from_target : start.pose();
}

Recogniser::Regions Recogniser::region(const Transform<LeftCamera, Target>& placed,
                                       int margin_px) const {
  Regions out;
  constexpr double kFar = 1e9;
  Eigen::Vector2d low[2], high[2];
  for (const int eye : {0, 1}) low[eye].setConstant(kFar), high[eye].setConstant(-kFar);
  for (const double x : {low_m_.x(), (low_m_.x() + high_m_.x()) / 2, high_m_.x()}) {
    for (const double y : {low_m_.y(), (low_m_.y() + high_m_.y()) / 2, high_m_.y()}) {
      const Eigen::Vector3d p = placed({x, y, 0});
      for (const int eye : {0, 1}) {
        const auto pixel =
            eye == 0 ? rig_.left.project(p) : rig_.right.project(rig_.right_from_left(p));
        if (!pixel || pixel->cwiseAbs().maxCoeff() > kFar) return out;
        low[eye] = low[eye].cwiseMin(*pixel);
        high[eye] = high[eye].cwiseMax(*pixel);
      }
    }
  }
  const auto box = [margin_px](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const auto whole = [](double v) { return static_cast<int>(std::floor(v)); };
    return vision::Region{whole(from.x()) - margin_px, whole(from.y()) - margin_px,
                          whole(to.x()) + 1 + margin_px, whole(to.y()) + 1 + margin_px};
  };
  out = {box(low[0], high[0]), box(low[1], high[1]), true};
  return out;
}

// The global check: a few coarse candidates in every frame.
void Recogniser::watch(const vision::PreparedFrame& frame, const vision::Hypothesis& own,
                       Parallel& parallel) {
  if (!watch_is_seeded_) {
    for (const Rival& r : rivals_) {
      if (r.score > 0 && elsewhere(r.translation, own)) {
        watch_.offer({r.genes.data(), RivalWatch::kGenes}, r.score);
      }
    }
    watch_is_seeded_ = true;
  }
  std::fill(rivals_.begin(), rivals_.end(), Rival{-1, {}, {}});
  const int n = std::clamp(config_.watch_candidates, RivalWatch::kPlaces, kBatch);
  watch_.propose(genes_, n);
  score_batch(frame, fitness_->levels(target_) - 1, n, parallel);
  note_rivals(n);
  const auto count = static_cast<std::size_t>(n);
  watch_.learn(genes_, {scores_.data(), count},
               [&](std::size_t i) { return !elsewhere(hypotheses_[i].translation, own); });
}

Recognition Recogniser::follow(const vision::PreparedFrame& frame,
                               const Transform<LeftCamera, Target>& placed, bool with_watch,
                               Parallel& parallel) {
  const vision::Hypothesis start = vision::Hypothesis::from(placed);
  double spent = 1;
  if (with_watch) {
    watch(frame, start, parallel);
    spent += config_.watch_candidates * target_.cost(fitness_->levels(target_) - 1);
  }
  Recognition out = finish(frame, start, score_one(frame, 0, start), spent, true);
  if (with_watch) challenge(frame, out);
  return out;
}

// What looks better from afar, and whoever asked may want to look at: another place, or the same
// place tilted the other way, which is the wrong answer that resembles the right one most.
void Recogniser::challenge(const vision::PreparedFrame& frame, Recognition& own) {
  constexpr float kClearly = 0.03f;
  const int level = fitness_->levels(target_) - 1;
  auto to_beat = static_cast<float>(own.coarse_fitness);
  if (watch_.best_score() > to_beat + kClearly) {
    to_beat = watch_.best_score();
    own.challenged = true;
    own.challenger = space_.decode(watch_.best()).pose();
  }
  std::array<vision::Hypothesis, 3> mirrored;
  const int count = mirror(own.left_from_target, mirrored);
  for (const vision::Hypothesis& other :
       std::span(mirrored).first(static_cast<std::size_t>(count))) {
    const float score = score_one(frame, level, other);
    own.evaluations += target_.cost(level);
    if (score <= to_beat) continue;
    to_beat = score;
    own.challenged = true;
    own.challenger = other.pose();
  }
}

// The pose tilted the other way, about x, about y and about both, where it is tilted at all.
int Recogniser::mirror(const Transform<LeftCamera, Target>& pose,
                       std::array<vision::Hypothesis, 3>& out) const {
  constexpr float kTilted = 0.1f;  // of the range of a tilt, from square
  constexpr std::size_t kTiltX = 3, kTiltY = 4;
  std::array<float, 8> genes = {};
  space_.encode(pose, genes);
  const bool tilted_x = std::abs(genes[kTiltX] - 0.5f) >= kTilted;
  const bool tilted_y = std::abs(genes[kTiltY] - 0.5f) >= kTilted;
  std::size_t count = 0;
  for (const bool flip_x : {false, true}) {
    for (const bool flip_y : {false, true}) {
      if ((!flip_x && !flip_y) || (flip_x && !tilted_x) || (flip_y && !tilted_y)) continue;
      std::array<float, 8> other = genes;
      if (flip_x) other[kTiltX] = 1 - genes[kTiltX];
      if (flip_y) other[kTiltY] = 1 - genes[kTiltY];
      out[count++] = space_.decode({other.data(), 6});
    }
  }
  return static_cast<int>(count);
}

// Evaluations that try_tilts() spends: what its refinements take of time, and its answers' scores.
double Recogniser::tilts_cost(int tilts, int answers) const {
  constexpr double kRefinement = 10, kAnswer = 40;  // measured
  return tilts * (kRefinement + target_.cost(coarse_level())) + answers * kAnswer;
}

// A search that has found the place may have ended on a wrong tilt of it: the true one's basin is
// narrow, and the pose tilted the other way resembles it. Others are looked at from there, each
// refined on coarse pixels; the best ones are finished.
void Recogniser::try_tilts(const vision::PreparedFrame& frame, bool all, Recognition& best) {
  constexpr std::size_t kTiltX = 3, kTiltY = 4;
  std::array<vision::Hypothesis, kTilts * kTilts> tilted;
  std::size_t count = 0;
  std::array<float, 8> genes = {};
  space_.encode(best.left_from_target, genes);
  if (all) {
    for (std::size_t i = 0; i < tilted.size(); ++i) {
      genes[kTiltX] = (static_cast<float>(i % kTilts) + 0.5f) / kTilts;
      genes[kTiltY] = (static_cast<float>(i / kTilts) + 0.5f) / kTilts;
      tilted[count++] = space_.decode({genes.data(), 6});
    }
  } else {
    std::array<vision::Hypothesis, 3> mirrored;
    count = static_cast<std::size_t>(mirror(best.left_from_target, mirrored));
    std::copy_n(mirrored.begin(), count, tilted.begin());
  }
  const int answers = std::min(all ? kTiltAnswers : 1, static_cast<int>(count));
  const double spent = best.evaluations + tilts_cost(static_cast<int>(count), answers);
  vision::RefineOptions options;
  options.level = coarse_level();
  options.iterations = 3;
  const vision::PointSet& points = target_.level[static_cast<std::size_t>(options.level)];
  std::array<float, kTilts* kTilts> scores = {};
  for (std::size_t i = 0; i < count; ++i) {
    const vision::Refinement refined =
        vision::refine_pose(optics_, points, frame, tilted[i].pose(), options);
    if (refined.ok) {
      space_.encode(refined.left_from_target, genes);  // which keeps it inside
      tilted[i] = space_.decode({genes.data(), 6});
    }
    scores[i] = score_one(frame, options.level, tilted[i]);
  }
  for (int k = 0; k < answers; ++k) {
    const auto at = std::max_element(scores.begin(), scores.begin() + static_cast<int>(count));
    const vision::Hypothesis& start = tilted[static_cast<std::size_t>(at - scores.begin())];
    *at = -std::numeric_limits<float>::infinity();
    const Recognition answer = finish(frame, start, score_one(frame, 0, start), spent);
    if (answer.fitness > best.fitness) best = answer;
  }
  best.evaluations = spent;
}

// The direction from eye_ (x, y, 1) to where a pixel's line of sight meets a plane (n/d). Behind a
// port lines of sight do not meet in one point.
Eigen::Vector3d Recogniser::ray_of(const Eigen::Vector2d& pixel,
                                   const Eigen::Vector3d& plane) const {
  if (!rig_.left.port) return rig_.left.ray(pixel);
  Line sight = rig_.left.line(pixel).value_or(Line{});
  sight.origin -= eye_;
  const Eigen::Vector3d point = sight.at_plane(plane, 1);
  return point / point.z();
}

// The ray for one plane of the pixel whose ray for another one this is.
Eigen::Vector3d Recogniser::aimed(const Eigen::Vector3d& ray, const Eigen::Vector3d& from,
                                  const Eigen::Vector3d& to) const {
  if (!rig_.left.port) return ray;
  const auto pixel = rig_.left.project(eye_ + ray / from.dot(ray));
  return pixel ? ray_of(*pixel, to) : ray;
}

// Behind a port the rays are right for the plane alone that they were aimed at: aimed at the one
// that was found, it is found once more.
vision::Refinement Recogniser::refine_plane(const vision::PreparedFrame& frame,
                                            const Transform<LeftCamera, Target>& start) {
  vision::PointSet& points = target_.level[0];
  const vision::Refinement first =
      vision::refine_plane(optics_, points, frame, start, centre_ray_, {});
  if (!rig_.left.port || !first.ok) return first;
  const Eigen::Vector3d normal = first.left_from_target.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d plane = normal / normal.dot(first.left_from_target.translation);
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (std::isnan(points.x[i])) continue;
    const Eigen::Vector3d ray = aimed(
        {static_cast<double>(points.x[i]), static_cast<double>(points.y[i]), 1}, level_aim_, plane);
    points.x[i] = static_cast<float>(ray.x());
    points.y[i] = static_cast<float>(ray.y());
  }
  centre_ray_ = aimed(centre_ray_, level_aim_, plane);
  space_.fix_ray(centre_ray_);
  level_aim_ = plane;
  return vision::refine_plane(optics_, points, frame, vision::pose_of_plane(plane, centre_ray_),
                              centre_ray_, {});
}

double Recogniser::found_threshold() const {
  if (fitness_->needs().packed) return config_.found_fitness;
  if (target_.unscaled) return config_.found_votes;
  // Photo-model votes: a share of what a perfect match would score.
  const vision::PointSet& set = target_.level[0];
  return config_.found_votes * (2.0 * set.inside + 0.1 * set.outside) / set.points();
}

// Whether what is there is the target: alike, and by how much more than the best place elsewhere.
bool Recogniser::is_target(const vision::PreparedFrame& frame, const vision::Hypothesis& answer,
                           bool locked, Recognition& out) {
  const double lead = std::max(0.0, out.coarse_fitness - std::max(0.0, out.rival_fitness));
  out.evaluations += 1;
  if (fitness_->needs().packed && !target_.unscaled) {
    out.likeness = vision::likeness(optics_, target_.level[0], frame, out.left_from_target);
    return out.likeness + kLeadCounts * lead >= (locked ? kKeep : 1) * config_.found_likeness;
  }
  // Both eyes must see it: what one eye alone agrees with has no measured depth, and a wrong
  // calibration looks like that. True poses gave 0.43 and more in the weaker eye, others 0.22 and
  // less.
  constexpr double kEyeShare = 0.55;
  const auto weaker_eye =
      static_cast<double>(fitness_->weaker_eye(target_, frame, answer, scratch_[0]));
  return out.fitness + lead >= found_threshold() && weaker_eye >= kEyeShare * found_threshold();
}

Recognition Recogniser::finish(const vision::PreparedFrame& frame, const vision::Hypothesis& best,
                               float best_score, double evaluations, bool locked) {
  Recognition out;
  out.left_from_target = best.pose();
  out.fitness = static_cast<double>(best_score);
  out.evaluations = evaluations;
  const vision::PointSet& points = target_.level[0];
  const vision::RefineOptions options;
  if (target_.unscaled) {
    // The same plane, with the smallest rotation to its normal.
    const Eigen::Vector3d normal = out.left_from_target.rotation * Eigen::Vector3d::UnitZ();
    out.left_from_target =
        vision::pose_of_plane(normal / normal.dot(out.left_from_target.translation), centre_ray_);
  }
  const vision::Refinement refined =
      !config_.refine ? vision::Refinement{}
      : target_.unscaled
          ? refine_plane(frame, out.left_from_target)
          : vision::refine_pose(optics_, points, frame, out.left_from_target, options);
  bool has_optimum = !config_.refine;
  if (!config_.refine) out.covariance = search_covariance();
  if (refined.ok) {
    const vision::Hypothesis candidate = vision::Hypothesis::from(refined.left_from_target);
    float score = 0;
    fitness_->score(target_, frame, 0, {&candidate, 1}, {&score, 1}, scratch_[0]);
    out.evaluations += 1;
    // Nearest-pixel scores are rough by about this much.
    constexpr double kRough = 0.01;
    // The refinement knows no box, and a measurement of a target near its border may well fall
    // beyond it: then the answer is the search's own, which does not. An optimum far outside is
    // none of what was asked for.
    constexpr SearchSpace::Slack kNear = {0.05, 0.26};
    has_optimum = space_.contains(refined.left_from_target, kNear);
    if (static_cast<double>(score) >= out.fitness - kRough &&
        space_.contains(refined.left_from_target)) {
      out.left_from_target = refined.left_from_target;
      out.fitness = static_cast<double>(score);
      out.refined = true;
    }
    out.covariance = refined.covariance;
    if (!out.refined) out.covariance += spread(out.left_from_target, refined.left_from_target);
  }
  const vision::Hypothesis answer = vision::Hypothesis::from(out.left_from_target);
  float coarse = 0;
  fitness_->score(target_, frame, fitness_->levels(target_) - 1, {&answer, 1}, {&coarse, 1},
                  scratch_[0]);
  out.coarse_fitness = static_cast<double>(coarse);
  out.rival_fitness = static_cast<double>(best_rival(answer));
  out.evaluations += target_.cost(fitness_->levels(target_) - 1);
  out.found = has_optimum && is_target(frame, answer, locked, out);
  out.reason = out.found ? TrackReason::kNone : TrackReason::kNotFound;
  out.size_m = size_m_;
  if (config_.relief && !target_.unscaled && out.refined) {
    const vision::Refinement solid =
        relief_.refine(optics_, points, frame, refined, options, locked && out.found);
    if (space_.contains(solid.left_from_target)) {
      out.left_from_target = solid.left_from_target;
      out.covariance = solid.covariance;
    }
  }
  if (target_.unscaled) {
    const Eigen::Vector3d n = out.left_from_target.rotation * Eigen::Vector3d::UnitZ();
    const double d = n.dot(out.left_from_target.translation);
    const auto on_plane = [&](double u, double v) -> Eigen::Vector3d {
      const Eigen::Vector3d ray = ray_of({u, v}, n / d);
      return ray * d / n.dot(ray);
    };
    const double left = rectangle_.x - 0.5, right = left + rectangle_.width;
    const double top = rectangle_.y - 0.5, bottom = top + rectangle_.height;
    const double mid_u = (left + right) / 2, mid_v = (top + bottom) / 2;
    out.size_m = {(on_plane(right, mid_v) - on_plane(left, mid_v)).norm(),
                  (on_plane(mid_u, bottom) - on_plane(mid_u, top)).norm()};
    out.left_from_target.translation += eye_;
  }
  return out;
}

void Recogniser::score(const vision::PreparedFrame& frame,
                       std::span<const vision::Hypothesis> hypotheses, std::span<float> scores,
                       Parallel& parallel) {
  const int n = static_cast<int>(hypotheses.size());
  parallel.for_each((n + kChunk - 1) / kChunk, [&](int chunk, int worker) {
    const auto first = static_cast<std::size_t>(chunk * kChunk);
    const std::size_t count = std::min<std::size_t>(kChunk, hypotheses.size() - first);
    fitness_->score(target_, frame, 0, hypotheses.subspan(first, count),
                    scores.subspan(first, count), scratch_[static_cast<std::size_t>(worker)]);
  });
}

bool Recogniser::to_model(const Transform<LeftCamera, Target>& pose,
                          vision::PatchModel& out) const {
  if (!target_.unscaled || !has_target_) return false;
  const Transform<LeftCamera, Target> seen = {pose.rotation, pose.translation - eye_};
  const auto target_from_left = seen.inverse();
  const Eigen::Vector3d n = seen.rotation * Eigen::Vector3d::UnitZ();
  const double d = n.dot(seen.translation);
  out.points.clear();
  out.inside_count = 0;
  for (const vision::ModelPoint& p : points_) {
    if (!p.inside) continue;
    const Eigen::Vector3d ray =
        aimed({static_cast<double>(p.x_m), static_cast<double>(p.y_m), 1}, aim_, n / d);
    const double along = n.dot(ray);
    if (along * d <= 0) return false;
    const Eigen::Vector3d on_target = target_from_left(ray * (d / along));
    vision::ModelPoint q = p;
    q.x_m = static_cast<float>(on_target.x());
    q.y_m = static_cast<float>(on_target.y());
    out.points.push_back(q);
    ++out.inside_count;
  }
  out.spacing_m = spacing_ * pose.translation.z();
  out.eye_m = target_from_left.translation;
  out.background = background_;
  out.background_hue = target_.background_hue;
  return out.inside_count >= 16;
}

}  // namespace gannet::track

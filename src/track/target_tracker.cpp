#include "src/track/target_tracker.hpp"

#include <optional>

#include "src/track/recogniser.hpp"
#include "src/track/track_config.hpp"
#include "src/track/track_state.hpp"
#include "src/vision/symmetry.hpp"

namespace gannet::track {
namespace {

// The config for targets of this kind: the papers' fitnesses each score one kind only, and the
// other kind then takes the paper's own for it.
TrackConfig config_for(TrackConfig config, TargetKind kind) {
  if (config.fitness == "gannet") return config;
  if (kind == TargetKind::kRectangle) config.fitness = "p000";
  if (kind == TargetKind::kModel && config.fitness == "p000") config.fitness = "p002";
  return config;
}

class Tracker final : public TargetTracker {
 public:
  Tracker(const TrackConfig& config, const StereoRig& rig, std::vector<vision::PatchModel> models,
          std::unique_ptr<Recogniser> for_models, std::unique_ptr<Recogniser> for_rectangles)
      : config_(config),
        width_(rig.left.width),
        height_(rig.left.height),
        models_(std::move(models)),
        for_models_(std::move(for_models)),
        for_rectangles_(std::move(for_rectangles)),
        frame_(width_, height_, joined_needs()),
        state_(config.lock_frames, from_seconds(config.coast_s)) {
    live_.points.reserve(static_cast<std::size_t>(Recogniser::max_points()));
  }

  bool choose_model(int index, std::uint32_t id) override {
    if (index < 0 || static_cast<std::size_t>(index) >= models_.size()) return false;
    if (!for_models_->set_model(models_[static_cast<std::size_t>(index)])) return false;
    begin(Seeking::kModel, index, id);
    return true;
  }

  bool choose_rectangle(const vision::Rectangle& r, std::uint32_t id) override {
    if (r.width < 8 || r.height < 8 || r.x < 0 || r.y < 0 || r.width > width_ ||
        r.height > height_ || r.x > width_ - r.width || r.y > height_ - r.height) {
      return false;
    }
    rectangle_ = r;
    begin(Seeking::kNewRectangle, -1, id);
    return true;
  }

  void choose_none() override { begin(Seeking::kNothing, -1, 0); }

  PoseEstimate process(const hal::ImageView& left, const hal::ImageView& right,
                       TimePoint capture_time, std::uint64_t frame_number, const Budget& budget,
                       Parallel& parallel) override {
    PoseEstimate out = blank(capture_time);
    out.frame_number = frame_number;
    if (seeking_ == Seeking::kNothing) return out;
    const std::optional<Transform<LeftCamera, Target>> predicted = predict(capture_time);
    if (left.width != width_ || left.height != height_ || right.width != width_ ||
        right.height != height_) {
      out.state = state_.step(false, capture_time);
      out.reason = TrackReason::kNoFrames;
      return out;
    }
    Recognition r;
    if (predicted && may_follow()) r = follow(left, right, *predicted, parallel);
    if (!r.found) {
      frame_.prepare(left, right);
      Budget spend = budget;
      if (spend.evaluations <= 0) {
        spend.evaluations = state_.state() == TrackState::kLocked ? config_.evaluations_tracking
                                                                  : config_.evaluations;
      }
      // A search from nothing must end, or a computer that is slower than its cameras never finds
      // anything: every newer pair would begin it anew.
      if (!in_view()) spend.stop = nullptr;
      r = recognise(predicted ? &*predicted : nullptr, spend, parallel);
    }
    if (r.found) stay(r, parallel);
    fill(out, r);
    const bool jumped = r.found && predicted && doubted(r, *predicted);
    if (jumped) out.reason = TrackReason::kJumped;
    out.found = r.found && !jumped;
    if (out.found) remember(r, capture_time);
    out.state = state_.step(out.found, capture_time);
    if (!out.found && !jumped && out.state == TrackState::kCoasting) {
      out.reason = TrackReason::kLowFitness;
    }
    if (out.found && seeking_ == Seeking::kRectangle) adopt_live_model(r);
    return out;
  }

  PoseEstimate no_frame(TimePoint now) override {
    PoseEstimate out = blank(now);
    if (seeking_ == Seeking::kNothing) return out;
    out.reason = TrackReason::kNoFrames;
    if (in_view()) {
      out.state = state_.step(false, now);
    }
    return out;
  }

 private:
  // A rectangle is first taken from the next frame, then found by Pb3DP in that same frame, and
  // goes on as a metric model of its own.
  enum class Seeking { kNothing, kModel, kNewRectangle, kRectangle };

  vision::PlaneNeeds joined_needs() const {
    const vision::PlaneNeeds a = for_models_->needs();
    const vision::PlaneNeeds b = for_rectangles_->needs();
    return {a.packed || b.packed, a.hue_value || b.hue_value};
  }

  bool in_view() const {
    return state_.state() == TrackState::kLocked || state_.state() == TrackState::kCoasting;
  }

  void begin(Seeking seeking, int model, std::uint32_t id) {
    seeking_ = seeking;
    model_ = model;
    id_ = id;
    state_.restart();
    has_last_ = false;
    speed_.setZero();
    doubts_ = 0;
    pause_ = 0;
  }

  PoseEstimate blank(TimePoint time) const {
    PoseEstimate out;
    out.capture_time = time;
    out.target_id = id_;
    out.model = model_;
    out.state = state_.state();
    out.reason = seeking_ == Seeking::kNothing ? TrackReason::kNoTarget : TrackReason::kNotFound;
    return out;
  }

  Recognition recognise(const Transform<LeftCamera, Target>* hint, const Budget& budget,
                        Parallel& parallel) {
    if (seeking_ == Seeking::kModel) return for_models_->recognise(frame_, hint, budget, parallel);
    // The patch is a piece of the current left image in every frame (P000 §2.1).
    const bool taken = seeking_ == Seeking::kNewRectangle
                           ? for_rectangles_->set_rectangle(rectangle_, frame_)
                           : for_rectangles_->refresh_rectangle(rectangle_, frame_);
    if (!taken) return {};
    seeking_ = Seeking::kRectangle;
    return for_rectangles_->recognise(frame_, nullptr, budget, parallel);
  }

  bool may_follow() const {
    const bool was_seen =
        state_.state() == TrackState::kLocked || state_.state() == TrackState::kCoasting;
    return was_seen && seeking_ == Seeking::kModel && for_models_->can_follow();
  }

  // Only what is needed: coarse levels of all, full detail about the target. Not found: the quick
  // way does not suffice here.
  Recognition follow(const hal::ImageView& left, const hal::ImageView& right,
                     const Transform<LeftCamera, Target>& predicted, Parallel& parallel) {
    Recogniser& sut = *for_models_;
    frame_.prepare_coarse(left, right, sut.coarse_level());
    const auto look_at = [&](const Transform<LeftCamera, Target>& hint, bool with_watch) {
      constexpr int kMargin = 12, kLeft = 3;  // pixels before and after the refinement
      const auto placed = sut.place(frame_, hint, parallel);
      const Recogniser::Regions wanted = sut.region(placed, kMargin);
      if (!wanted.ok) return Recognition{};
      frame_.prepare_fine(left, right, wanted.left, wanted.right);
      Recognition r = sut.follow(frame_, placed, with_watch, parallel);
      const Recogniser::Regions used = sut.region(r.left_from_target, kLeft);
      // What was placed on coarse pixels alone is no measurement.
      r.found = r.found && r.refined && used.ok && contains(wanted.left, used.left) &&
                contains(wanted.right, used.right);
      return r;
    };
    Recognition own = look_at(predicted, true);
    // A sudden loss of fitness may be another attitude: only a whole search tells.
    constexpr double kSudden = 0.06;
    if (own.fitness < usual_fitness_ - kSudden) own.found = false;
    if (!own.found || !own.challenged) return own;
    // What lost is let alone for a while; what won is looked at until it is believed.
    constexpr int kPause = 15;  // frames
    if (pause_ > 0) {
      --pause_;
      return own;
    }
    const Recognition other = look_at(own.challenger, false);
    constexpr double kClearly = 0.02;
    if (other.found && other.fitness > own.fitness + kClearly) return other;
    pause_ = kPause;
    return own;
  }

  static bool contains(const vision::Region& a, const vision::Region& b) {
    return b.left >= a.left && b.top >= a.top && b.right <= a.right && b.bottom <= a.bottom;
  }

  // The moment that depth and tilt are known the patch becomes an ordinary photo-model.
  void adopt_live_model(const Recognition& r) {
    live_.size_m = r.size_m;
    if (!for_rectangles_->to_model(r.left_from_target, live_)) return;
    if (for_models_->set_model(live_)) seeking_ = Seeking::kModel;
  }

  std::optional<Transform<LeftCamera, Target>> predict(TimePoint time) const {
    if (!has_last_ || state_.state() == TrackState::kLost) return std::nullopt;
    auto pose = last_pose_;
    pose.translation += speed_ * to_seconds(time - last_time_);
    return pose;
  }

  // Of poses that look alike to this frame, the one nearest to the last: a symmetric target must
  // not flip. What fits clearly better is taken as it is.
  void stay(Recognition& r, Parallel& parallel) {
    if (seeking_ != Seeking::kModel || model_ < 0 || !has_last_) return;
    const vision::Symmetry& symmetry = models_[static_cast<std::size_t>(model_)].symmetry;
    if (!symmetry.exists()) return;
    const auto pose = vision::nearest_equivalent(symmetry, r.left_from_target, last_pose_.rotation);
    if (pose.rotation.coeffs() == r.left_from_target.rotation.coeffs()) return;
    constexpr double kAlike = 0.05;  // of fitness: what pixels and the photo's own noise do
    const vision::Hypothesis other = vision::Hypothesis::from(pose);
    float score = 0;
    for_models_->score(frame_, {&other, 1}, {&score, 1}, parallel);
    r.evaluations += 1;
    if (static_cast<double>(score) < r.fitness - kAlike) return;
    r.left_from_target = pose;
    r.fitness = static_cast<double>(score);
  }

  bool doubted(const Recognition& r, const Transform<LeftCamera, Target>& predicted) {
    const bool locked =
        state_.state() == TrackState::kLocked || state_.state() == TrackState::kCoasting;
    const double away = (r.left_from_target.translation - predicted.translation).norm();
    doubts_ = locked && away > config_.jump_m ? doubts_ + 1 : 0;
    return doubts_ > 0 && doubts_ <= config_.lock_frames;
  }

  void remember(const Recognition& r, TimePoint time) {
    const double dt = has_last_ ? to_seconds(time - last_time_) : 0;
    // A hint for the search only; the filter on the servo thread is what motion is judged by.
    constexpr double kLongestStep = 0.5;  // s
    constexpr double kFastest = 2;        // m/s
    if (dt > 0 && dt < kLongestStep && doubts_ == 0) {
      const Eigen::Vector3d now = (r.left_from_target.translation - last_pose_.translation) / dt;
      speed_ = 0.5 * (speed_ + now);
      if (speed_.norm() > kFastest) speed_.setZero();
    } else {
      speed_.setZero();
    }
    constexpr double kSlowly = 0.1;  // light and water change over many frames
    usual_fitness_ += (has_last_ ? kSlowly : 1) * (r.fitness - usual_fitness_);
    doubts_ = 0;
    last_pose_ = r.left_from_target;
    last_time_ = time;
    has_last_ = true;
  }

  static void fill(PoseEstimate& out, const Recognition& r) {
    out.reason = r.reason;
    out.left_from_target = r.left_from_target;
    out.covariance = r.covariance;
    out.size_m = r.size_m;
    out.fitness = r.fitness;
    out.evaluations = r.evaluations;
  }

  const TrackConfig config_;
  const int width_;
  const int height_;
  const std::vector<vision::PatchModel> models_;
  std::unique_ptr<Recogniser> for_models_;
  std::unique_ptr<Recogniser> for_rectangles_;
  vision::PreparedFrame frame_;
  TrackStateMachine state_;
  Seeking seeking_ = Seeking::kNothing;
  int model_ = -1;
  std::uint32_t id_ = 0;
  vision::Rectangle rectangle_;
  vision::PatchModel live_;
  bool has_last_ = false;
  Transform<LeftCamera, Target> last_pose_;
  TimePoint last_time_ = {};
  Eigen::Vector3d speed_ = Eigen::Vector3d::Zero();
  int doubts_ = 0;
  double usual_fitness_ = 0;  // of late
  int pause_ = 0;             // frames until a challenger may be looked at again
};

}  // namespace

Result<std::unique_ptr<TargetTracker>> TargetTracker::create(
    const TrackConfig& config, const StereoRig& rig, std::vector<vision::PatchModel> models) {
  constexpr int kMostWorkers = 16;
  auto for_models = Recogniser::create(config_for(config, TargetKind::kModel), rig,
                                       TargetKind::kModel, kMostWorkers);
  if (!for_models) return for_models.error();
  auto for_rectangles = Recogniser::create(config_for(config, TargetKind::kRectangle), rig,
                                           TargetKind::kRectangle, kMostWorkers);
  if (!for_rectangles) return for_rectangles.error();
  for (const vision::PatchModel& model : models) {
    if (static_cast<int>(model.points.size()) > Recogniser::max_points()) {
      return Error{"model " + model.name + " has " + std::to_string(model.points.size()) +
                   " points; at most " + std::to_string(Recogniser::max_points()) +
                   " are possible: lower track.model_points"};
    }
  }
  return std::unique_ptr<TargetTracker>(new Tracker(
      config, rig, std::move(models), std::move(*for_models), std::move(*for_rectangles)));
}

}  // namespace gannet::track

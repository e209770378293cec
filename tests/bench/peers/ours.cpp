#include <cstring>

#include "src/track/recogniser.hpp"
#include "src/track/target_tracker.hpp"
#include "tests/bench/peers/peers.hpp"

namespace gannet::bench {
namespace {

class Single : public Peer {
 public:
  Single(const StereoRig& rig, vision::PatchModel model)
      : recogniser_(track::Recogniser::create({}, rig, track::TargetKind::kModel).value()),
        model_(std::move(model)),
        frame_(rig.left.width, rig.left.height, recogniser_->needs()) {}

  const char* name() const override { return "gannet, from nothing"; }
  void begin(const Pose&) override { recogniser_->set_model(model_); }  // forgets
  Answer look(const View& view) override {
    frame_.prepare(view.left.view(), view.right.view());
    const track::Recognition got = recogniser_->recognise(frame_, nullptr, {}, serial_);
    return {got.found, got.left_from_target};
  }

 private:
  std::unique_ptr<track::Recogniser> recogniser_;
  vision::PatchModel model_;
  vision::PreparedFrame frame_;
  Serial serial_;
};

class Film : public Peer {
 public:
  Film(const StereoRig& rig, vision::PatchModel model)
      : tracker_(
            track::TargetTracker::create(track::TrackConfig{}, rig, {std::move(model)}).value()) {}

  const char* name() const override { return "gannet, tracking"; }
  void begin(const Pose&) override {
    tracker_->choose_none();
    tracker_->choose_model(0, ++id_);
  }
  Answer look(const View& view) override {
    ++number_;
    const auto now = time_from_ns(33'333'333LL * static_cast<std::int64_t>(number_));
    const PoseEstimate got =
        tracker_->process(view.left.view(), view.right.view(), now, number_, {}, serial_);
    return {got.found, got.left_from_target};
  }

 private:
  std::unique_ptr<track::TargetTracker> tracker_;
  std::uint32_t id_ = 0;
  std::uint64_t number_ = 0;
  Serial serial_;
};

}  // namespace

vision::PatchModel model_of(const world::TargetPhoto& photo, const StereoRig& rig, int points) {
  hal::Image mask(rig.left.width, rig.left.height, hal::PixelFormat::kYuv444);
  std::memcpy(mask.plane(0), photo.mask.samples.data(), photo.mask.samples.size());
  const hal::ImageView background = photo.background.view(), mask_view = mask.view();
  vision::PhotoInput input;
  input.target = photo.target.view();
  input.background = &background;
  input.mask = &mask_view;
  input.distance_m = kPhotoRange_m;
  input.name = "square";
  vision::BuildOptions options;
  options.inside_points = points;
  return vision::make_patch_model(vision::cut_out(input, rig.left).value(), options).value();
}

std::unique_ptr<Peer> gannet_single(const StereoRig& rig, const world::TargetPhoto& photo) {
  return std::make_unique<Single>(rig, model_of(photo, rig, track::TrackConfig{}.model_points));
}

std::unique_ptr<Peer> gannet_film(const StereoRig& rig, const world::TargetPhoto& photo) {
  return std::make_unique<Film>(rig, model_of(photo, rig, track::TrackConfig{}.model_points));
}

}  // namespace gannet::bench

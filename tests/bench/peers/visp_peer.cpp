#include "tests/bench/peers/peers.hpp"
#include "tests/bench/peers/visp_template.hpp"

namespace gannet::bench {
namespace {

Eigen::Matrix3d pixels_from_metres(const Intrinsics& camera, const Pose& pose) {
  Eigen::Matrix3d intrinsic, plane = pose.rotation.toRotationMatrix();
  intrinsic << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1;
  plane.col(2) = pose.translation;
  return intrinsic * plane;
}

class VispPeer : public Peer {
 public:
  VispPeer(const Intrinsics& camera, std::unique_ptr<VispTemplate> tracker)
      : camera_(camera), tracker_(std::move(tracker)) {
    Pose photo;
    photo.translation.z() = kPhotoRange_m;
    metres_from_photo_ = pixels_from_metres(camera, photo).inverse();
  }

  const char* name() const override { return "ViSP template (ZNCC)"; }
  void begin(const Pose& start) override {
    tracker_->start_at(pixels_from_metres(camera_, start) * metres_from_photo_);
  }
  Answer look(const View& view) override {
    const auto h = tracker_->track(view.left.plane(0), 2);  // of YUYV the Y
    return h ? plane_pose(*h * metres_from_photo_.inverse(), camera_) : Answer{};
  }

 private:
  Intrinsics camera_;
  std::unique_ptr<VispTemplate> tracker_;
  Eigen::Matrix3d metres_from_photo_;
};

}  // namespace

std::unique_ptr<Peer> visp_template(const StereoRig& rig, const world::TargetPhoto& photo) {
  const double half_px = rig.left.fx * kSide_m / kPhotoRange_m / 2 - 1;
  auto tracker = VispTemplate::create(photo.target.plane(0), rig.left.width, rig.left.height,
                                      rig.left.cx, rig.left.cy, half_px);
  if (tracker == nullptr) return nullptr;
  return std::make_unique<VispPeer>(rig.left, std::move(tracker));
}

}  // namespace gannet::bench

#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/tag36h11.h>

#include <cstdlib>

#include "tests/bench/peers/peers.hpp"

namespace gannet::bench {
namespace {

class AprilTag : public Peer {
 public:
  explicit AprilTag(const StereoRig& rig)
      : camera_(rig.left),
        family_(tag36h11_create()),
        detector_(apriltag_detector_create()),
        grey_(image_u8_create(static_cast<unsigned>(rig.left.width),
                              static_cast<unsigned>(rig.left.height))) {
    apriltag_detector_add_family(detector_, family_);
    detector_->nthreads = 1;
    detector_->quad_decimate = 1;  // all pixels: range and dark count more than speed here
  }
  ~AprilTag() override {
    image_u8_destroy(grey_);
    apriltag_detector_destroy(detector_);
    tag36h11_destroy(family_);
  }
  AprilTag(const AprilTag&) = delete;
  AprilTag& operator=(const AprilTag&) = delete;

  const char* name() const override { return "AprilTag"; }
  bool wants_tag() const override { return true; }
  void begin(const Pose&) override {}

  Answer look(const View& view) override {
    for (int y = 0; y < grey_->height; ++y) {
      const std::uint8_t* from = view.left.row(0, y);
      for (int x = 0; x < grey_->width; ++x) grey_->buf[y * grey_->stride + x] = from[2 * x];
    }
    zarray_t* found = apriltag_detector_detect(detector_, grey_);
    Answer out;
    for (int i = 0; i < zarray_size(found); ++i) {
      apriltag_detection_t* one = nullptr;
      zarray_get(found, i, &one);
      if (one->id == 0 && !out.found) out = pose_of(one);
    }
    apriltag_detections_destroy(found);
    return out;
  }

 private:
  Answer pose_of(apriltag_detection_t* detection) const {
    // The margin is one cell wide all round; the size that counts is that of the black square.
    const double edge_m = kSide_m * family_->width_at_border / family_->total_width;
    // The library counts pixels from their corners.
    apriltag_detection_info_t info = {detection,  edge_m,           camera_.fx,
                                      camera_.fy, camera_.cx + 0.5, camera_.cy + 0.5};
    apriltag_pose_t pose;
    estimate_tag_pose(&info, &pose);
    Answer out;
    out.found = true;
    Eigen::Matrix3d turn;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        turn(r, c) = MATD_EL(pose.R, r, c);
      }
      out.pose.translation[r] = MATD_EL(pose.t, r, 0);
    }
    out.pose.rotation = Eigen::Quaterniond(turn);
    std::free(pose.R);  // Debian's library keeps matd_destroy to itself
    std::free(pose.t);
    return out;
  }

  Intrinsics camera_;
  apriltag_family_t* family_;
  apriltag_detector_t* detector_;
  image_u8_t* grey_;
};

}  // namespace

image_file::Raster8 april_tag_picture() {
  constexpr int kCell = 48;
  apriltag_family_t* family = tag36h11_create();
  image_u8_t* cells = apriltag_to_image(family, 0);
  image_file::Raster8 out(cells->width * kCell, cells->height * kCell, 1);
  for (int y = 0; y < out.height; ++y) {
    for (int x = 0; x < out.width; ++x) {
      *out.at(x, y) = cells->buf[y / kCell * cells->stride + x / kCell] == 0 ? 40 : 160;
    }
  }
  image_u8_destroy(cells);
  tag36h11_destroy(family);
  return out;
}

std::unique_ptr<Peer> april_tag(const StereoRig& rig) { return std::make_unique<AprilTag>(rig); }

}  // namespace gannet::bench

// The contenders, ours and the peers, each as a competent user would set it up, behind one face.
// Peers look through the left camera alone, as they are made to; Gannet uses both.
// Benchmarks only, one thread.
#pragma once

#include <memory>

#include "src/image_file/raster.hpp"
#include "src/vision/patch_model.hpp"
#include "tests/bench/peers/views.hpp"

namespace gannet::bench {

struct Answer {
  bool found = false;
  Pose pose;
};

class Peer {
 public:
  virtual ~Peer() = default;
  virtual const char* name() const = 0;
  virtual bool wants_tag() const { return false; }
  // A new single view or film. start: the true first pose, which only trackers that cannot find
  // the target by themselves may use.
  virtual void begin(const Pose& start) = 0;
  virtual Answer look(const View& view) = 0;
};

vision::PatchModel model_of(const world::TargetPhoto& photo, const StereoRig& rig, int points);

std::unique_ptr<Peer> gannet_single(const StereoRig& rig, const world::TargetPhoto& photo);
std::unique_ptr<Peer> gannet_film(const StereoRig& rig, const world::TargetPhoto& photo);

// Features of the photo matched to the frame's (ratio test), homography by RANSAC, plane pose
// (IPPE) of its inliers, Levenberg–Marquardt.
enum class Features { kOrb, kAkaze };
std::unique_ptr<Peer> opencv_features(Features kind, const StereoRig& rig,
                                      const world::TargetPhoto& photo);
// Template alignment by the enhanced correlation coefficient (Evangelidis & Psarakis, 2008), a
// homography warm-started from the frame before.
std::unique_ptr<Peer> opencv_ecc(const StereoRig& rig, const world::TargetPhoto& photo);

// ViSP's template tracker with the photo as its template, warm-started as ECC is. Null: built
// without ViSP.
std::unique_ptr<Peer> visp_template(const StereoRig& rig, const world::TargetPhoto& photo);

// Pose of a plane from its homography (metres on the plane to pixels), by its outline of kSide_m.
Answer plane_pose(const Eigen::Matrix3d& pixels_from_metres, const Intrinsics& camera);

// tag36h11 number 0 with its white margin, as a picture to print.
image_file::Raster8 april_tag_picture();
std::unique_ptr<Peer> april_tag(const StereoRig& rig);

}  // namespace gannet::bench

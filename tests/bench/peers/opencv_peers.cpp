#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "tests/bench/peers/peers.hpp"

namespace gannet::bench {
namespace {

cv::Matx33d matrix_of(const Intrinsics& c) { return {c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1}; }

// cv::Mat knows no const; nothing writes through these.
cv::Mat grey_of_yuyv(const hal::Image& image) {
  const cv::Mat pairs(image.height(), image.width(), CV_8UC2,
                      const_cast<std::uint8_t*>(image.plane(0)),
                      static_cast<std::size_t>(image.stride(0)));
  cv::Mat grey;
  cv::extractChannel(pairs, grey, 0);
  return grey;
}

cv::Mat grey_of_photo(const hal::Image& image) {
  return cv::Mat(image.height(), image.width(), CV_8UC1, const_cast<std::uint8_t*>(image.plane(0)),
                 static_cast<std::size_t>(image.stride(0)))
      .clone();
}

Answer plane_pose(const std::vector<cv::Point3d>& points, const std::vector<cv::Point2d>& pixels,
                  const cv::Matx33d& camera) {
  cv::Vec3d rotation, translation;
  const cv::Mat no_lens;
  if (!cv::solvePnP(points, pixels, camera, no_lens, rotation, translation, false,
                    cv::SOLVEPNP_IPPE)) {
    return {};
  }
  cv::solvePnPRefineLM(points, pixels, camera, no_lens, rotation, translation);
  cv::Matx33d turn;
  cv::Rodrigues(rotation, turn);
  Answer out;
  out.found = translation[2] > 0;
  out.pose.rotation = Eigen::Quaterniond(
      Eigen::Matrix3d(Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(turn.val)));
  out.pose.translation = {translation[0], translation[1], translation[2]};
  return out;
}

class FeaturePeer : public Peer {
 public:
  FeaturePeer(Features kind, const StereoRig& rig, const world::TargetPhoto& photo)
      : orb_(kind == Features::kOrb), camera_(matrix_of(rig.left)) {
    // More than the defaults give: the ground has features, too, and of the target too few are
    // left.
    if (orb_) {
      detector_ = cv::ORB::create(10000, 1.2f, 8, 31, 0, 2, cv::ORB::HARRIS_SCORE, 31, 10);
    } else {
      detector_ = cv::AKAZE::create();
      detector_.dynamicCast<cv::AKAZE>()->setThreshold(2e-4);
    }
    cv::Mat mask(photo.mask.height, photo.mask.width, CV_8UC1,
                 const_cast<std::uint8_t*>(photo.mask.samples.data()));
    std::vector<cv::KeyPoint> keys;
    detector_->detectAndCompute(grey_of_photo(photo.target), mask, keys, descriptors_);
    for (const cv::KeyPoint& key : keys) {
      const Eigen::Vector3d p = kPhotoRange_m * rig.left.ray({key.pt.x, key.pt.y});
      model_.emplace_back(p.x(), p.y(), 0);
    }
  }

  const char* name() const override { return orb_ ? "OpenCV ORB + PnP" : "OpenCV AKAZE + PnP"; }
  void begin(const Pose&) override {}
  Answer look(const View& view) override {
    std::vector<cv::KeyPoint> keys;
    cv::Mat descriptors;
    detector_->detectAndCompute(grey_of_yuyv(view.left), cv::noArray(), keys, descriptors);
    if (keys.size() < 2) return {};
    std::vector<std::vector<cv::DMatch>> pairs;
    matcher_.knnMatch(descriptors_, descriptors, pairs, 2);
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> flat, pixels;
    for (const auto& pair : pairs) {
      if (pair.size() < 2 || pair[0].distance > 0.8f * pair[1].distance) continue;
      const cv::Point3d& p = model_[static_cast<std::size_t>(pair[0].queryIdx)];
      points.push_back(p);
      flat.emplace_back(p.x, p.y);
      pixels.emplace_back(keys[static_cast<std::size_t>(pair[0].trainIdx)].pt);
    }
    constexpr std::size_t kFewest = 8;
    if (points.size() < kFewest) return {};
    cv::Mat inlier;
    if (cv::findHomography(flat, pixels, cv::RANSAC, 3, inlier, 2000, 0.999).empty()) return {};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (inlier.at<std::uint8_t>(static_cast<int>(i)) == 0) continue;
      points[kept] = points[i];
      pixels[kept++] = pixels[i];
    }
    if (kept < kFewest) return {};
    points.resize(kept);
    pixels.resize(kept);
    return plane_pose(points, pixels, camera_);
  }

 private:
  bool orb_;
  cv::Matx33d camera_;
  cv::Ptr<cv::Feature2D> detector_;
  cv::BFMatcher matcher_{cv::NORM_HAMMING};
  cv::Mat descriptors_;
  std::vector<cv::Point3d> model_;
};

class EccPeer : public Peer {
 public:
  EccPeer(const StereoRig& rig, const world::TargetPhoto& photo) : camera_(matrix_of(rig.left)) {
    // The target's square of the photo at half resolution: as large as in a frame at 0.8 m.
    const double px = rig.left.fx * kSide_m / kPhotoRange_m;
    const cv::Rect place(static_cast<int>(rig.left.cx - px / 2),
                         static_cast<int>(rig.left.cy - px / 2), static_cast<int>(px),
                         static_cast<int>(px));
    const cv::Mat cut = grey_of_photo(photo.target)(place);
    cv::resize(cut, template_, {cut.cols / 2, cut.rows / 2}, 0, 0, cv::INTER_AREA);
    metres_ = kPhotoRange_m / rig.left.fx * 2;
    origin_px_ = {(rig.left.cx - place.x - 0.5) / 2, (rig.left.cy - place.y - 0.5) / 2};
  }

  const char* name() const override { return "OpenCV ECC"; }

  void begin(const Pose& start) override {
    const Eigen::Matrix3d r = start.rotation.toRotationMatrix();
    const Eigen::Vector3d& t = start.translation;
    const cv::Matx33d plane(r(0, 0), r(0, 1), t.x(), r(1, 0), r(1, 1), t.y(), r(2, 0), r(2, 1),
                            t.z());
    const cv::Matx33d metres(metres_, 0, -metres_ * origin_px_.x, 0, metres_,
                             -metres_ * origin_px_.y, 0, 0, 1);
    const cv::Matx33d h = camera_ * plane * metres;
    cv::Mat(h * (1 / h(2, 2))).convertTo(warp_, CV_32F);
  }

  Answer look(const View& view) override {
    cv::Mat warp = warp_.clone();
    try {
      const double agreement = cv::findTransformECC(
          template_, grey_of_yuyv(view.left), warp, cv::MOTION_HOMOGRAPHY,
          {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-5}, cv::noArray(), 5);
      if (agreement < 0.5) return {};
    } catch (const cv::Exception&) {
      return {};  // did not converge; the next frame starts from the last that did
    }
    warp_ = warp;
    const auto w = static_cast<double>(template_.cols - 1);
    const auto h = static_cast<double>(template_.rows - 1);
    const std::vector<cv::Point2d> corners = {{0, 0}, {w, 0}, {w, h}, {0, h}};
    std::vector<cv::Point2d> pixels;
    cv::perspectiveTransform(corners, pixels, warp);
    std::vector<cv::Point3d> points;
    for (const cv::Point2d& c : corners) {
      points.emplace_back((c.x - origin_px_.x) * metres_, (c.y - origin_px_.y) * metres_, 0);
    }
    return plane_pose(points, pixels, camera_);
  }

 private:
  cv::Matx33d camera_;
  cv::Mat template_, warp_;
  double metres_ = 0;  // of a pixel of the template
  cv::Point2d origin_px_;
};

}  // namespace

Answer plane_pose(const Eigen::Matrix3d& pixels_from_metres, const Intrinsics& camera) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const double x : {-kSide_m / 2, kSide_m / 2}) {
    for (const double y : {-kSide_m / 2, kSide_m / 2}) {
      const Eigen::Vector2d pixel = (pixels_from_metres * Eigen::Vector3d(x, y, 1)).hnormalized();
      points.emplace_back(x, y, 0);
      pixels.emplace_back(pixel.x(), pixel.y());
    }
  }
  return plane_pose(points, pixels, matrix_of(camera));
}

std::unique_ptr<Peer> opencv_features(Features kind, const StereoRig& rig,
                                      const world::TargetPhoto& photo) {
  return std::make_unique<FeaturePeer>(kind, rig, photo);
}

std::unique_ptr<Peer> opencv_ecc(const StereoRig& rig, const world::TargetPhoto& photo) {
  return std::make_unique<EccPeer>(rig, photo);
}

}  // namespace gannet::bench

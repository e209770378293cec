// One evaluation, the same sums as vision::reference::correlation, of OpenCV's parts: the points by
// perspectiveTransform, the image by remap, the moments by array operations.
#include <array>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "src/vision/correlation_fitness.hpp"
#include "src/vision/fitness_kinds.hpp"
#include "src/vision/kernel_choice.hpp"
#include "src/vision/reference.hpp"
#include "tests/bench/peers/evaluation.hpp"
#include "tests/bench/workload.hpp"

namespace gannet::bench {
namespace {

class OpencvEvaluation {
 public:
  explicit OpencvEvaluation(const Workload& work) : rig_(work.rig) {
    const vision::PointSet& set = work.points();
    std::array<std::vector<float>, 3> colour;
    for (std::size_t i = 0; i < set.x.size(); ++i) {
      if (std::isnan(set.x[i])) continue;  // padding
      points_.emplace_back(set.x[i], set.y[i]);
      const float own[3] = {set.colour[i].y, set.colour[i].u, set.colour[i].v};
      for (std::size_t c = 0; c < 3; ++c) colour[c].push_back(own[c]);
    }
    inside_ = set.inside;
    for (std::size_t c = 0; c < 3; ++c) model_[c] = cv::Mat(colour[c], true).reshape(1, 1);
    for (const bool left : {true, false}) {
      const vision::EyePlanes& eye = left ? work.frame->left() : work.frame->right();
      std::array<cv::Mat, 3> planes;
      for (std::size_t c = 0; c < 3; ++c) {
        planes[c] = cv::Mat(eye.height, eye.width, CV_8UC1);
        std::memcpy(planes[c].data, eye.smooth[c], planes[c].total());
      }
      cv::merge(planes.data(), 3, images_[left ? 0 : 1]);
    }
  }

  double score(const Pose& pose) {
    return (eye(images_[0], homography(rig_.left, pose.translation, pose.rotation)) +
            eye(images_[1], homography(rig_.right, rig_.right_from_left(pose.translation),
                                       rig_.right_from_left.rotation * pose.rotation))) /
           2;
  }

 private:
  static cv::Matx33d homography(const Intrinsics& camera, const Eigen::Vector3d& t,
                                const Eigen::Quaterniond& rotation) {
    const Eigen::Matrix3d r = rotation.toRotationMatrix();
    return cv::Matx33d(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1) *
           cv::Matx33d(r(0, 0), r(0, 1), t.x(), r(1, 0), r(1, 1), t.y(), r(2, 0), r(2, 1), t.z());
  }

  double eye(const cv::Mat& image, const cv::Matx33d& plane) {
    cv::perspectiveTransform(points_, pixels_, plane);
    const cv::Mat map(1, static_cast<int>(pixels_.size()), CV_32FC2, pixels_.data());
    // Outside is 0, and the mask leaves it out of the model's sums, too.
    cv::remap(image, seen_, map, cv::noArray(), cv::INTER_NEAREST, cv::BORDER_CONSTANT);
    cv::inRange(map, cv::Scalar(-0.5, -0.5), cv::Scalar(image.cols - 0.501, image.rows - 0.501),
                mask_);
    mask_.convertTo(counts_, CV_32F, 1.0 / 255);
    seen_.convertTo(colours_, CV_32F);
    cv::split(colours_, channels_.data());
    const double share = cv::sum(counts_)[0] / map.cols;
    if (share < static_cast<double>(options_.least_share)) return share - 1;
    const double a = static_cast<double>(options_.inside_share);
    return ((1 - a) * mean(map.cols) + a * mean(inside_)) *
           std::min(1.0, share / static_cast<double>(options_.full_share));
  }

  // Over the first so many points.
  double mean(int points) {
    const cv::Range range(0, points);
    const cv::Mat counts = counts_.colRange(range);
    const double n = cv::sum(counts)[0];
    double sum = 0, weights = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const cv::Mat image = channels_[c].colRange(range), model = model_[c].colRange(range);
      cv::multiply(model, counts, masked_);
      const double i = cv::sum(image)[0] / n, m = cv::sum(masked_)[0] / n;
      const double var_image = image.dot(image) / n - i * i;
      const double var_model = masked_.dot(masked_) / n - m * m;
      const double floor = static_cast<double>(c == 0 ? options_.floor_y : options_.floor_uv);
      const double weight = static_cast<double>(c == 0 ? options_.weight_y : options_.weight_uv);
      const double w = var_model / (var_model + weight * weight);
      sum += w * (image.dot(masked_) / n - i * m) /
             std::sqrt((var_image + floor * floor) * (var_model + floor * floor));
      weights += w;
    }
    return weights > 0 ? sum / weights : 0;
  }

  StereoRig rig_;
  vision::CorrelationOptions options_;
  int inside_ = 0;
  std::vector<cv::Point2f> points_, pixels_;
  std::array<cv::Mat, 3> model_, channels_;
  std::array<cv::Mat, 2> images_;
  cv::Mat seen_, mask_, counts_, colours_, masked_;
};

}  // namespace

void evaluation_with_opencv(Results& results) {
  constexpr int kTurns = 41;
  results.group("one evaluation",
                "The default fitness, both images, poses as a search proposes them; beside it the "
                "same sums of perspectiveTransform, remap and array operations. One thread.");
  const ClutteredScene scene(640, 480);
  const Workload work = model_workload(scene, 400, 256, false);
  const auto ours = vision::make_fitness("gannet", work.target().unscaled, work.rig,
                                         *vision::find_kernels("auto"))
                        .value();
  OpencvEvaluation theirs(work);
  double apart = 0;
  for (const Pose& pose : work.poses) {
    const double truth =
        vision::reference::correlation(work.rig, work.target(), *work.frame, pose, {});
    apart = std::max(apart, std::abs(theirs.score(pose) - truth));
  }
  vision::Scratch scratch(track::Recogniser::max_points());
  std::array<float, kTurnCandidates> scores;
  const auto times =
      interleave({{"gannet",
                   [&](int turn) {
                     ours->score(work.target(), *work.frame, 0,
                                 {work.candidates.data() + work.first(turn), kTurnCandidates},
                                 scores, scratch);
                     consume(static_cast<double>(scores[0]));
                     return static_cast<double>(kTurnCandidates);
                   }},
                  {"OpenCV",
                   [&](int turn) {
                     const std::size_t first = work.first(turn);
                     for (std::size_t i = first; i < first + kTurnCandidates; ++i) {
                       consume(theirs.score(work.poses[i]));
                     }
                     return static_cast<double>(kTurnCandidates);
                   }}},
                 kTurns);
  const auto us = [](std::vector<double> ns) {
    for (double& t : ns) t /= 1e3;
    return spread_of(ns);
  };
  const std::string points = std::to_string(work.points().points()) + " points x 2 images";
  char note[120];
  std::snprintf(note, sizeof note, "%s; at most %.1e from the reference's score in %zu poses",
                points.c_str(), apart, work.poses.size());
  results.add({"gannet", "us", us(times[0]), kTurns, {}, points});
  results.add({"with OpenCV",
               "us",
               us(times[1]),
               kTurns,
               {{"times our time", spread_of(ratios_of(times[1], times[0]))}},
               note});
}

}  // namespace gannet::bench

#include "src/track/relief.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::track {
namespace {

using vision::Refinement;

constexpr int kRounds = 4;
constexpr double kRate = 1.0 / 16;            // of the running mean, a frame
constexpr double kPays = -0.02, kNo = -0.01;  // of the mean log of the variances
constexpr int kPatience = 64;                 // frames after the last round
constexpr double kFade = 1.0 / 30;            // a frame

double log_variance_ratio(const Refinement& with, const Refinement& without) {
  double sum = 0;
  int channels = 0;
  for (std::size_t c = 0; c < with.looks.size(); ++c) {
    if (!with.looks[c].ok || !without.looks[c].ok) continue;
    sum += std::log(with.looks[c].variance / without.looks[c].variance);
    ++channels;
  }
  return channels == 0 ? 0 : sum / channels;
}

Transform<LeftCamera, Target> between(const Transform<LeftCamera, Target>& a,
                                      const Transform<LeftCamera, Target>& b, double share) {
  return {canonical(a.rotation.slerp(share, b.rotation)),
          a.translation + share * (b.translation - a.translation)};
}

}  // namespace

Relief::Relief(int max_points) : estimator_(max_points) { solid_.reserve(max_points); }

void Relief::reset(const vision::PointSet& flat, double spacing_m, const Eigen::Vector3d& eye_m) {
  spacing_m_ = spacing_m;
  eye_m_ = eye_m;
  estimator_.reset(flat, spacing_m, eye_m);
  rounds_ = idle_ = 0;
  gain_ = share_ = 0;
  in_use_ = false;
}

Refinement Relief::refine(const vision::RigOptics& optics, const vision::PointSet& flat_points,
                          const vision::PreparedFrame& frame, const Refinement& flat,
                          const vision::RefineOptions& options, bool locked) {
  Refinement out = flat;
  if (idle_ >= kPatience) return out;
  if (rounds_ > 0) {
    const Refinement solid =
        vision::refine_pose(optics, solid_, frame, flat.left_from_target, options);
    if (locked && solid.ok) {
      gain_ += kRate * (log_variance_ratio(solid, flat) - gain_);
      in_use_ = gain_ < (in_use_ ? kNo : kPays);
      if (rounds_ == kRounds && !in_use_ && share_ <= 0) ++idle_;
    }
    share_ = std::clamp(share_ + (in_use_ ? kFade : -kFade), 0.0, 1.0);
    if (solid.ok && share_ > 0) {
      out = solid;
      out.left_from_target = between(flat.left_from_target, solid.left_from_target, share_);
    }
  }
  if (locked && rounds_ < kRounds) {
    estimator_.see(optics.rig, flat_points, frame, out);
    if (estimator_.complete()) {
      estimator_.lay(flat_points, solid_);
      if (++rounds_ < kRounds) estimator_.reset(flat_points, spacing_m_, eye_m_);
    }
  }
  return out;
}

}  // namespace gannet::track

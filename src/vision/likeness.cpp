#include "src/vision/likeness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/vision/refine_problem.hpp"

namespace gannet::vision {
namespace {

constexpr double kRounding = 0.3;              // grey levels, of a byte
constexpr double kFullShare = 0.85;            // of S_in that an eye must see for full marks,
constexpr double kLeastShare = 0.5;            // and to count at all
constexpr float kBand = 0.3f;                  // weight of S_out, of which only the mean is known
constexpr double kMostAlike = 0.98;            // of ρ²
constexpr int kLeastPoints = 8;                // for a correlation
constexpr double kWeightY = 12, kWeightC = 5;  // contrast, in grey levels, that counts half

struct Mean {
  double sum = 0, weights = 0;

  void add(const RefineSums<6>& sums) {
    for (int c = 0; c < 3; ++c) add(ChannelSums<6>(sums.lanes[c]), c == 0 ? kWeightY : kWeightC);
  }
  void add(const ChannelSums<6>& s, double half) {
    if (s.w < kLeastPoints) return;
    const auto moment = [&s](double ab, double a, double b) { return (ab - a * b / s.w) / s.w; };
    const double of_model = moment(s.mm, s.m, s.m);
    const double covariance = std::max(0.0, moment(s.im, s.i, s.m));
    const double floor = kRounding * kRounding;
    const double rho2 =
        covariance * covariance / ((of_model + floor) * (moment(s.ii, s.i, s.i) + floor));
    const double weight = of_model / (of_model + half * half);
    sum -= weight * std::log(1 - std::min(rho2, kMostAlike));
    weights += weight;
  }
  double value() const { return weights > 0 ? sum / weights : 0; }
};

}  // namespace

double likeness(const RigOptics& optics, const PointSet& points, const PreparedFrame& frame,
                const Transform<LeftCamera, Target>& pose) {
  const RefineOptions options;
  const Problem<6> problem = {optics, points, frame, options};
  double weaker = std::numeric_limits<double>::infinity();
  for (const bool right : {false, true}) {
    const Intrinsics& camera = right ? optics.rig.right : optics.rig.left;
    const RefineEye eye = problem.eye_of(right, camera, eye_at(pose));
    RefineSums<6> sums;
    problem.add(right, camera, eye, 0, points.inside_padded, 1, sums);
    const double share = ChannelSums<6>(sums.lanes[0]).w / points.inside;
    if (!(share >= kLeastShare)) return 0;
    Mean mean;
    mean.add(sums);
    problem.add(right, camera, eye, points.inside_padded, points.total_padded, kBand, sums);
    mean.add(sums);
    weaker = std::min(weaker, std::min(1.0, share / kFullShare) * mean.value());
  }
  return weaker;
}

}  // namespace gannet::vision

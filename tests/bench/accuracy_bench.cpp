// Accuracy of a locked target's pose beside the Cramér–Rao bound of the very same images, and
// whether the covariance that goes with it is true.
//
// The bound is (Σ ∂I/∂θ ∂I/∂θᵀ / σ²)⁻¹ over the pixels inside the target in both images and all
// three channels: by differences of noise-free images, σ² with what rounding to bytes adds. The
// outline, which also tells something, is left out of it; brightness is taken as known, which it is
// not to the tracker.
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "src/track/target_tracker.hpp"
#include "src/track/track_config.hpp"
#include "tests/bench/benches.hpp"
#include "tests/bench/cluttered_scene.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::bench {
namespace {

test::FlatScene scene_of(const Options& options) {
  test::FlatScene scene;
  for (Intrinsics* camera : {&scene.rig.left, &scene.rig.right}) {
    camera->width = options.width();
    camera->height = options.height();
    camera->fx = camera->fy = options.width();
    camera->cx = (camera->width - 1) / 2.0;
    camera->cy = (camera->height - 1) / 2.0;
  }
  return scene;
}

Pose moved(const Pose& pose, int axis, double by) {
  Pose out = pose;
  if (axis < 3) {
    out.translation[axis] += by;
  } else {
    const Eigen::Vector3d turn = by * Eigen::Vector3d::Unit(axis - 3);
    out.rotation = quaternion_from_rotation_vector(turn) * pose.rotation;
  }
  return out;
}

Matrix6d cramer_rao(const test::FlatScene& scene, const Pose& truth) {
  constexpr double kStep = 2e-4;  // m, rad: a tenth of a pixel
  Matrix6d information = Matrix6d::Zero();
  const double variance = scene.noise * scene.noise + 1.0 / 12;
  for (const bool left : {true, false}) {
    std::array<std::vector<double>, 12> seen;
    for (int axis = 0; axis < 6; ++axis) {
      for (int side = 0; side < 2; ++side) {
        const Pose at = moved(truth, axis, side == 0 ? kStep : -kStep);
        seen[static_cast<std::size_t>(2 * axis + side)] = scene.colours(left, &at);
      }
    }
    const Intrinsics& camera = left ? scene.rig.left : scene.rig.right;
    for (int i = 0; i < camera.width * camera.height; ++i) {
      const auto inside = [&](const Pose& pose) {
        return scene.on_target(left, pose, i % camera.width, i / camera.width);
      };
      if (!inside(truth)) continue;
      bool border = false;
      for (int axis = 0; axis < 6; ++axis) {
        border |= !inside(moved(truth, axis, kStep)) || !inside(moved(truth, axis, -kStep));
      }
      if (border) continue;
      for (int channel = 0; channel < 3; ++channel) {
        const auto at = static_cast<std::size_t>(3 * i + channel);
        Vector6d slope;
        for (std::size_t axis = 0; axis < 6; ++axis) {
          slope[static_cast<int>(axis)] =
              (seen[2 * axis][at] - seen[2 * axis + 1][at]) / (2 * kStep);
        }
        information += slope * slope.transpose() / variance;
      }
    }
  }
  return information.inverse();
}

Vector6d error_of(const Pose& measured, const Pose& truth) {
  Vector6d error;
  error << measured.translation - truth.translation,
      rotation_vector_from_quaternion(canonical(measured.rotation * truth.rotation.conjugate()));
  return error;
}

struct Tally {
  std::vector<double> spread[6];  // times the bound, pose by pose
  std::vector<double> bias_z;     // share of z
  std::vector<double> nees;       // trial by trial, against the truth
  int within = 0;                 // the 95 % bound of χ² with six degrees of freedom
  int missed = 0;
};

void measure(const test::FlatScene& scene, const vision::PatchModel& model, const Pose& truth,
             int trials, std::uint64_t seed, Tally& tally) {
  constexpr int kSettle = 3;
  constexpr double kChi2 = 12.592;
  const auto sut = track::TargetTracker::create(track::TrackConfig{}, scene.rig, {model}).value();
  sut->choose_model(0, 1);
  const std::vector<double> left = scene.colours(true, &truth),
                            right = scene.colours(false, &truth);
  Serial serial;
  std::vector<Vector6d> errors;
  for (int i = 0; i < trials + kSettle; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const test::Picture l = scene.noisy(true, left, seed + 2 * number);
    const test::Picture r = scene.noisy(false, right, seed + 2 * number + 1);
    const PoseEstimate got = sut->process(l.view(), r.view(), time_from_ns(33'000'000LL * (i + 1)),
                                          number + 1, {}, serial);
    if (i < kSettle) continue;
    if (!got.found) {
      ++tally.missed;
      continue;
    }
    errors.push_back(error_of(got.left_from_target, truth));
    const double nees = errors.back().dot(got.covariance.inverse() * errors.back());
    tally.nees.push_back(nees);
    tally.within += nees <= kChi2;
  }
  if (errors.size() < 2) return;
  Vector6d mean = Vector6d::Zero(), square = Vector6d::Zero();
  for (const Vector6d& e : errors) mean += e / static_cast<double>(errors.size());
  for (const Vector6d& e : errors) {
    square += (e - mean).cwiseAbs2() / static_cast<double>(errors.size() - 1);
  }
  const Matrix6d bound = cramer_rao(scene, truth);
  for (int axis = 0; axis < 6; ++axis) {
    tally.spread[axis].push_back(std::sqrt(square[axis] / bound(axis, axis)));
  }
  tally.bias_z.push_back(100 * std::abs(mean.z()) / truth.translation.z());
}

}  // namespace

void bench_accuracy(const Options& options, Results& results) {
  results.group(
      "accuracy of a locked target",
      "A flat target 160 x 110 mm of smooth texture, model of one photo at 0.4 m with the "
      "same noise, still at random poses (z 0.4 to 1.0 m, tilts 30, roll 45 degrees), fresh "
      "noise in each pair. Spread: standard deviation over the Cramer-Rao bound of the "
      "same images (pixels inside the target, all channels). NEES: squared error against "
      "the truth by the reported covariance, 6 on average if it is true.");
  const int poses = options.quick ? 1 : 8;
  for (const double noise : {1.0, 3.0, 8.0}) {
    test::FlatScene scene = scene_of(options);
    scene.noise = noise;
    const auto model = scene.model(400).value();
    Random random(77);
    const auto either = [&](double scale) { return scale * (2 * random.uniform() - 1); };
    Tally tally;
    for (int i = 0; i < poses; ++i) {
      const double z = 0.4 + 0.6 * random.uniform();
      const double a = either(30), b = either(30), c = either(45);
      const Pose truth = test::pose_at(0.06 + either(0.1 * z), either(0.1 * z), z, a, b, c);
      measure(scene, model, truth, options.quick ? 4 : options.trials,
              1000 * static_cast<std::uint64_t>(i + 1), tally);
    }
    const std::string of = ", noise " + std::to_string(static_cast<int>(noise));
    constexpr const char* kAxes[] = {"x", "y", "z", "rx", "ry", "rz"};
    for (std::size_t axis = 0; axis < 6; ++axis) {
      results.add({std::string("spread of ") + kAxes[axis] + of,
                   "times the bound",
                   spread_of(tally.spread[axis]),
                   static_cast<int>(tally.nees.size()),
                   {},
                   "",
                   {at_most(1.5, "times the bound", quantile(tally.spread[axis], 0.5))}});
    }
    results.add({"bias of z" + of,
                 "% of z",
                 spread_of(tally.bias_z),
                 static_cast<int>(tally.nees.size()),
                 {},
                 std::to_string(tally.missed) + " not found",
                 {at_most(0.1, "% of z", quantile(tally.bias_z, 0.5))}});
    const int n = static_cast<int>(tally.nees.size());
    double mean = 0;
    for (const double e : tally.nees) mean += e / std::max(n, 1);
    char note[80];
    std::snprintf(note, sizeof note, "mean %.2f; %.1f %% within the 95 %% bound", mean,
                  100.0 * tally.within / std::max(n, 1));
    results.add({"NEES" + of, "", spread_of(tally.nees), n, {}, note});
  }
}

}  // namespace gannet::bench

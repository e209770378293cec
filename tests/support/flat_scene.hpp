// FlatScene: a smooth procedural texture on a plane in front of a smooth procedural background,
// seen by a stereo rig: pictures with exactly known truth and no files, for the unit tests of
// vision and track. Not the world's renderer: no light, no water, one ray a pixel of a band-limited
// texture.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "platform/base/random.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::test {

struct Picture {
  int width, height;
  std::vector<std::uint8_t> y, u, v;
  hal::ImageView view() const {
    hal::ImageView out;
    out.width = width;
    out.height = height;
    out.format = hal::PixelFormat::kYuv444;
    out.range = hal::ColourRange::kFull;
    out.plane = {y.data(), u.data(), v.data()};
    out.stride = {width, width, width};
    return out;
  }
};

// Sums of sines: smooth, so that point samples are exact, and unlike anywhere else.
class Texture {
 public:
  Texture(std::uint64_t seed, double wavelength_m, double contrast) : contrast_(contrast) {
    Random random(seed);
    for (Wave& w : waves_) {
      const double angle = 6.2832 * random.uniform();
      const double k = 6.2832 / wavelength_m * (0.4 + 1.2 * random.uniform());
      w = {k * std::cos(angle), k * std::sin(angle), 6.2832 * random.uniform()};
    }
  }
  double at(int channel, double x, double y) const {
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const Wave& w = waves_[4 * channel + i];
      sum += std::sin(w.kx * x + w.ky * y + w.phase);
    }
    return contrast_ * sum / 2;
  }

 private:
  struct Wave {
    double kx, ky, phase;
  };
  Wave waves_[12];
  double contrast_;
};

struct FlatScene {
  StereoRig rig;
  Eigen::Vector2d size_m = {0.16, 0.11};
  Texture target{11, 0.05, 35};
  Texture ground{12, 0.11, 12};
  double ground_z = 1.4;
  double noise = 1.0;    // grey levels
  bool twofold = false;  // the target looks the same after half a turn
  double bulge_m = 0;    // of the target's middle, towards who looks at it square: a dome

  FlatScene() {
    for (Intrinsics* camera : {&rig.left, &rig.right}) {
      camera->width = 320;
      camera->height = 240;
      camera->fx = camera->fy = 320;
      camera->cx = 159.5;
      camera->cy = 119.5;
    }
    rig.right_from_left.translation = {-0.12, 0, 0};
    rig.hand_from_left.translation = {-0.06, 0, 0};
  }

  // An ellipse, so that it has no symmetric outline under quarter turns.
  bool covers(double x, double y) const {
    const double a = 2 * x / size_m.x(), b = 2 * y / size_m.y();
    return a * a + b * b <= 1;
  }

  // z of the target's surface, in its frame.
  double dome(double x, double y) const {
    const double a = 2 * x / size_m.x(), b = 2 * y / size_m.y();
    return -bulge_m * std::max(0.0, 1 - a * a - b * b);
  }

  // What an ideal camera measures: Y, U, V of each pixel, row by row.
  std::vector<double> colours(bool left, const Transform<LeftCamera, Target>* pose) const {
    const Intrinsics& camera = left ? rig.left : rig.right;
    std::vector<double> out(3 * static_cast<std::size_t>(camera.width * camera.height));
    std::size_t at = 0;
    for (int row = 0; row < camera.height; ++row) {
      for (int col = 0; col < camera.width; ++col, at += 3) {
        const auto [origin, ray] = line_of_sight(left, col, row);
        shade(origin, ray, pose, &out[at]);
      }
    }
    return out;
  }

  // Whether a pixel's centre sees the target.
  bool on_target(bool left, const Transform<LeftCamera, Target>& pose, int col, int row) const {
    const auto [origin, ray] = line_of_sight(left, col, row);
    double x, y;
    return hits(origin, ray, pose, x, y);
  }

  // With this scene's noise, rounded to bytes.
  Picture noisy(bool left, const std::vector<double>& colours, std::uint64_t seed) const {
    const Intrinsics& camera = left ? rig.left : rig.right;
    Picture out = {camera.width, camera.height, {}, {}, {}};
    Random random(seed);
    const auto byte = [&](double c) {
      c += noise * static_cast<double>(random.normal_f());
      return static_cast<std::uint8_t>(std::clamp(std::lround(c), 0L, 255L));
    };
    for (std::size_t at = 0; at < colours.size(); at += 3) {
      out.y.push_back(byte(colours[at]));
      out.u.push_back(byte(colours[at + 1]));
      out.v.push_back(byte(colours[at + 2]));
    }
    return out;
  }

  Picture see(bool left, const Transform<LeftCamera, Target>* pose, std::uint64_t seed) const {
    return noisy(left, colours(left, pose), seed);
  }

  // The photo-model as a user would make it: a photo at 0.4 m and one of the background.
  Result<vision::PatchModel> model(int points = 500) const {
    const Transform<LeftCamera, Target> square = {Eigen::Quaterniond::Identity(), {0, 0, 0.4}};
    const Picture photo = see(true, &square, 101);
    const Picture empty = see(true, nullptr, 102);
    const hal::ImageView background = empty.view();
    vision::PhotoInput input;
    input.target = photo.view();
    input.background = &background;
    input.name = "ellipse";
    auto patch = vision::cut_out(input, rig.left);
    if (!patch) return patch.error();
    vision::BuildOptions options;
    options.inside_points = points;
    return vision::make_patch_model(*patch, options);
  }

  // What a pixel shows lies along here.
  struct Line {
    Eigen::Vector3d origin, ray;  // in Σ_CL
  };
  Line line_of_sight(bool left, int col, int row) const {
    const Line in_eye = sight(left ? rig.left : rig.right, {col, row});
    if (left) return in_eye;
    const auto left_from_eye = rig.right_from_left.inverse();
    return {left_from_eye(in_eye.origin), left_from_eye.rotation * in_eye.ray};
  }

 private:
  // Through a port face by face, by Snell's law between vectors: not as src/core does it, so that a
  // fault there cannot cancel itself.
  static Line sight(const Intrinsics& camera, const Eigen::Vector2d& pixel) {
    Line line = {Eigen::Vector3d::Zero(), camera.ray(pixel)};
    if (!camera.port) return line;
    const FlatPort& port = *camera.port;
    const Eigen::Vector3d& n = port.normal;
    line.ray.normalize();
    const auto meet = [&](double distance, double from, double to) {
      line.origin += line.ray * ((distance - n.dot(line.origin)) / n.dot(line.ray));
      const double ratio = from / to, cosine = n.dot(line.ray);
      const double cosine_after = std::sqrt(1 - ratio * ratio * (1 - cosine * cosine));
      line.ray = ratio * line.ray + (cosine_after - ratio * cosine) * n;
    };
    meet(port.distance_m, port.air_index, port.glass_index);
    meet(port.distance_m + port.thickness_m, port.glass_index, port.water_index);
    return line;
  }

  bool hits(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
            const Transform<LeftCamera, Target>& pose, double& x, double& y) const {
    const auto target_from_left = pose.inverse();
    const Eigen::Vector3d o = target_from_left(origin);
    const Eigen::Vector3d d = target_from_left.rotation * ray;
    double z = 0;
    for (int i = 0; i < (bulge_m == 0 ? 1 : 12); ++i) {  // converges for what is flatter than steep
      const Eigen::Vector3d hit = o + d * ((z - o.z()) / d.z());
      x = hit.x(), y = hit.y();
      z = dome(x, y);
    }
    return o.z() / d.z() < 0 && covers(x, y);
  }

  void shade(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray,
             const Transform<LeftCamera, Target>* pose, double* colour) const {
    double x, y;
    if (pose != nullptr && hits(origin, ray, *pose, x, y)) {
      const auto shown = [&](int channel) {
        const double here = target.at(channel, x, y);
        return twofold ? 0.7 * (here + target.at(channel, -x, -y)) : here;
      };
      colour[0] = 120 + shown(0);
      colour[1] = 100 + 0.6 * shown(1);
      colour[2] = 175 + 0.6 * shown(2);
      return;
    }
    const Eigen::Vector3d hit = origin + ray * ((ground_z - origin.z()) / ray.z());
    colour[0] = 90 + ground.at(0, hit.x(), hit.y());
    colour[1] = 150 + 0.3 * ground.at(1, hit.x(), hit.y());
    colour[2] = 105 + 0.3 * ground.at(2, hit.x(), hit.y());
  }
};

inline Transform<LeftCamera, Target> pose_at(double x, double y, double z, double rx_deg = 0,
                                             double ry_deg = 0, double rz_deg = 0) {
  constexpr double kDegree = 3.14159265358979 / 180;
  return {quaternion_from_rpy(rx_deg * kDegree, ry_deg * kDegree, rz_deg * kDegree), {x, y, z}};
}

}  // namespace gannet::test

#include "src/tool/preview.hpp"

#include <algorithm>
#include <optional>

#include "src/tool/drawing.hpp"

namespace gannet::tool {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

hal::Image crop_of(const vision::PhotoPatch& patch) {
  hal::Image crop(patch.width, patch.height, hal::PixelFormat::kYuv444);
  for (int y = 0; y < patch.height; ++y)
    for (int x = 0; x < patch.width; ++x)
      for (int c = 0; c < 3; ++c)
        crop.row(c, y)[x] = patch.yuv[static_cast<std::size_t>(3 * (y * patch.width + x) + c)];
  return hal::to_rgb24(crop.view());
}

// One eye of an overlay: where its image begins, and how points of the left camera come into it.
struct Eye {
  const Intrinsics& camera;
  std::optional<Transform<RightCamera, LeftCamera>> from_left;
  Vector2d corner;
  std::optional<Vector2d> pixel(const Vector3d& in_left) const {
    auto at = camera.project(from_left ? (*from_left)(in_left) : in_left);
    if (at) *at += corner;
    // A point far outside would draw into the other eye's image.
    const bool inside = at && at->x() >= corner.x() - 1 && at->x() <= corner.x() + camera.width;
    return inside ? at : std::nullopt;
  }
};

void draw_between(hal::Image& picture, const Eye& eye, const Vector3d& a, const Vector3d& b,
                  double width, Colour colour) {
  const auto from = eye.pixel(a);
  const auto to = eye.pixel(b);
  if (from && to) draw_line(picture, *from, *to, width, colour);
}

void draw_target(hal::Image& picture, const Eye& eye, const Transform<LeftCamera, Target>& pose,
                 const std::vector<Segment>& outline, double axis_m) {
  const auto on_plane = [&](const Vector2d& at) { return pose(Vector3d(at.x(), at.y(), 0)); };
  for (const Segment& s : outline)
    draw_between(picture, eye, on_plane(s.from), on_plane(s.to), 1, kMagenta);
  const Colour colours[3] = {kRed, kGreen, kBlue};
  for (int axis = 0; axis < 3; ++axis)
    draw_between(picture, eye, pose(Vector3d::Zero()), pose(axis_m * Vector3d::Unit(axis)), 3,
                 colours[axis]);
}

}  // namespace

std::vector<Segment> outline_of(const vision::PhotoPatch& patch) {
  const double dx = patch.distance_m / patch.fx;
  const double dy = patch.distance_m / patch.fy;
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < patch.width && y < patch.height &&
           patch.mask[static_cast<std::size_t>(y * patch.width + x)] != 0;
  };
  const auto corner = [&](int x, int y) -> Vector2d {
    return {(x - 0.5 - patch.centre_px.x()) * dx, (y - 0.5 - patch.centre_px.y()) * dy};
  };
  std::vector<Segment> outline;
  for (int y = 0; y <= patch.height; ++y)
    for (int x = 0; x <= patch.width; ++x) {
      if (inside(x, y) != inside(x - 1, y)) outline.push_back({corner(x, y), corner(x, y + 1)});
      if (inside(x, y) != inside(x, y - 1)) outline.push_back({corner(x, y), corner(x + 1, y)});
    }
  return outline;
}

std::vector<Segment> outline_of(const vision::Rectangle& r, const Intrinsics& left,
                                const Transform<LeftCamera, Target>& pose) {
  const Vector3d normal = pose.rotation * Vector3d::UnitZ();
  const double distance = normal.dot(pose.translation);
  const auto on_target = [&](double u, double v) -> Vector2d {
    const Vector3d ray = left.ray({u, v});
    return pose.inverse()(ray * distance / normal.dot(ray)).head<2>();
  };
  const double x0 = r.x - 0.5, x1 = x0 + r.width, y0 = r.y - 0.5, y1 = y0 + r.height;
  const Vector2d a = on_target(x0, y0), b = on_target(x1, y0), c = on_target(x1, y1),
                 d = on_target(x0, y1);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

hal::Image draw_preview(const vision::PhotoPatch& patch, const vision::PatchModel& model) {
  const int scale = std::clamp(720 / std::max(patch.width, patch.height), 1, 8);
  hal::Image picture(patch.width * scale, patch.height * scale, hal::PixelFormat::kRgb24);
  put(picture, crop_of(patch), 0, 0, scale);
  const auto at = [&](double x_m, double y_m) -> Vector2d {
    return {(patch.centre_px.x() + x_m * patch.fx / patch.distance_m + 0.5) * scale - 0.5,
            (patch.centre_px.y() + y_m * patch.fy / patch.distance_m + 0.5) * scale - 0.5};
  };
  for (const vision::ModelPoint& p : model.points)
    draw_dot(picture, at(static_cast<double>(p.x_m), static_cast<double>(p.y_m)), 0.8,
             p.inside ? kGreen : kBlue);
  for (const Segment& s : outline_of(patch))
    draw_line(picture, at(s.from.x(), s.from.y()), at(s.to.x(), s.to.y()), 1.5, kMagenta);
  draw_dot(picture, at(0, 0), 3, kYellow);
  return picture;
}

hal::Image draw_overlay(const hal::Image& left, const hal::Image& right, const StereoRig& rig,
                        const Transform<LeftCamera, Target>& pose,
                        const std::vector<Segment>& outline, double axis_m) {
  hal::Image picture(left.width() + right.width(), std::max(left.height(), right.height()),
                     hal::PixelFormat::kRgb24);
  put(picture, hal::to_rgb24(left.view()), 0, 0, 1);
  put(picture, hal::to_rgb24(right.view()), left.width(), 0, 1);
  draw_target(picture, {rig.left, std::nullopt, {0, 0}}, pose, outline, axis_m);
  draw_target(picture, {rig.right, rig.right_from_left, {left.width(), 0}}, pose, outline, axis_m);
  return picture;
}

}  // namespace gannet::tool

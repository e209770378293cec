#include "src/tool/preview.hpp"

#include <algorithm>
#include <optional>

#include "src/image_file/drawing.hpp"

namespace gannet::tool {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using image_file::Canvas;
namespace colours = image_file::colours;

constexpr int kGap = 4;  // pixels between the eyes
constexpr image_file::Colour kMagenta = {255, 0, 255};

hal::Image enlarged_crop(const vision::PhotoPatch& patch, int scale) {
  hal::Image crop(patch.width * scale, patch.height * scale, hal::PixelFormat::kYuv444);
  for (int y = 0; y < crop.height(); ++y)
    for (int x = 0; x < crop.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        const int at = 3 * (y / scale * patch.width + x / scale) + c;
        crop.row(c, y)[x] = patch.yuv[static_cast<std::size_t>(at)];
      }
  return hal::to_rgb24(crop.view());
}

// One eye of an overlay: where its image begins, and how points of the left camera come into it.
struct Eye {
  const Intrinsics& camera;
  std::optional<Transform<RightCamera, LeftCamera>> from_left;
  int first_column = 0;

  // Empty outside the image: it would be drawn into the other eye's.
  std::optional<image_file::Point> pixel(const Vector3d& in_left) const {
    const auto at = camera.project(from_left ? (*from_left)(in_left) : in_left);
    if (!at || at->x() < -1 || at->x() > camera.width) return std::nullopt;
    return image_file::Point{at->x() + first_column, at->y()};
  }
};

void draw_target(Canvas& canvas, const Eye& eye, const Transform<LeftCamera, Target>& pose,
                 const std::vector<Segment>& outline, double axis_m) {
  const auto pixel = [&](const Vector3d& on_target) { return eye.pixel(pose(on_target)); };
  for (const Segment& s : outline) {
    const auto from = pixel({s.from.x(), s.from.y(), 0});
    const auto to = pixel({s.to.x(), s.to.y(), 0});
    if (from && to) canvas.line(*from, *to, kMagenta, 1);
  }
  const image_file::Colour axes[3] = {colours::kRed, colours::kGreen, colours::kBlue};
  const auto origin = pixel(Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const auto end = pixel(axis_m * Vector3d::Unit(axis));
    if (origin && end) canvas.arrow(*origin, *end, axes[axis]);
  }
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
    const Line sight = left.line({u, v}).value_or(Line{});
    return pose.inverse()(sight.at_plane(normal, distance)).head<2>();
  };
  const double x0 = r.x - 0.5, x1 = x0 + r.width, y0 = r.y - 0.5, y1 = y0 + r.height;
  const Vector2d a = on_target(x0, y0), b = on_target(x1, y0), c = on_target(x1, y1),
                 d = on_target(x0, y1);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

hal::Image draw_preview(const vision::PhotoPatch& patch, const vision::PatchModel& model) {
  const int scale = std::clamp(1000 / std::max(patch.width, patch.height), 1, 8);
  hal::Image picture = enlarged_crop(patch, scale);
  Canvas canvas(picture);
  const auto at = [&](double x_m, double y_m) -> image_file::Point {
    return {(patch.centre_px.x() + x_m * patch.fx / patch.distance_m + 0.5) * scale - 0.5,
            (patch.centre_px.y() + y_m * patch.fy / patch.distance_m + 0.5) * scale - 0.5};
  };
  for (const vision::ModelPoint& p : model.points)
    canvas.disc(at(static_cast<double>(p.x_m), static_cast<double>(p.y_m)), 1,
                p.inside ? colours::kGreen : colours::kBlue);
  for (const Segment& s : outline_of(patch))
    canvas.line(at(s.from.x(), s.from.y()), at(s.to.x(), s.to.y()), kMagenta);
  canvas.disc(at(0, 0), 3, colours::kYellow);
  return picture;
}

hal::Image draw_overlay(const hal::Image& left, const hal::Image& right, const StereoRig& rig,
                        const Transform<LeftCamera, Target>& pose,
                        const std::vector<Segment>& outline, double axis_m) {
  hal::Image picture = image_file::side_by_side(left.view(), right.view(), kGap);
  Canvas canvas(picture);
  draw_target(canvas, {rig.left, std::nullopt, 0}, pose, outline, axis_m);
  draw_target(canvas, {rig.right, rig.right_from_left, left.width() + kGap}, pose, outline, axis_m);
  return picture;
}

}  // namespace gannet::tool

#include "src/world/renderer_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gannet::world {
namespace {

constexpr int kRun = 16;  // pixels between two nodes
// Looks along a footprint's long side; what is longer is blurred. A slanted bottom fills the
// picture, so it gets a single look two thirds as wide; the target, whose pose is measured, up
// to 4.
constexpr float kProbesOfTile = 1.5f;
constexpr float kProbesOfPicture = 4;
// What is nearer or farther is not drawn. A ray along a plane meets it endlessly far away, where no
// place of its picture is a number any more.
constexpr float kNearest_m = 0.02f, kFarthest_m = 1000;

bool is_drawn(float depth_m) { return depth_m > kNearest_m && depth_m < kFarthest_m; }

// Within 2e-4: mantissa by a polynomial, no libm, so the same everywhere. x > 0.
float log2_of(float x) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  const float m = std::bit_cast<float>((bits & 0x007fffffu) | 0x3f800000u);
  const float exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  return exponent +
         ((((-0.081615f * m + 0.645142f) * m - 2.120675f) * m + 4.070091f) * m - 2.512853f);
}

}  // namespace

Sight sight_of(const Intrinsics& camera, const Eigen::Vector2d& pixel) {
  if (!camera.port) {
    const Eigen::Vector3d ray = camera.ray(pixel);
    return {static_cast<float>(ray.x()), static_cast<float>(ray.y()), 0};
  }
  const Eigen::Vector3d& axis = camera.port->normal;
  const Line line = camera.line(pixel).value_or(Line{});
  // Along the line to its place nearest the axis, which it meets: there all that is left of it is
  // along the axis. A line along the axis meets it everywhere.
  const Eigen::Vector3d away = line.origin - axis.dot(line.origin) * axis;
  const Eigen::Vector3d turn = line.direction - axis.dot(line.direction) * axis;
  const double square = turn.squaredNorm();
  const double from = square < 1e-18
                          ? camera.port->pupil_m()
                          : axis.dot(line.origin - line.direction * (away.dot(turn) / square));
  return {static_cast<float>(line.direction.x()), static_cast<float>(line.direction.y()),
          static_cast<float>(from)};
}

SightTable::SightTable(const Intrinsics& camera)
    : columns_(static_cast<std::size_t>(camera.width) + 1) {
  const std::size_t size = columns_ * (static_cast<std::size_t>(camera.height) + 1);
  x_.reserve(size);
  y_.reserve(size);
  if (camera.port) from_.reserve(size);
  for (int row = 0; row <= camera.height; ++row) {
    for (int column = 0; column <= camera.width; ++column) {
      const Sight sight = sight_of(camera, {column, row});
      x_.push_back(sight.x);
      y_.push_back(sight.y);
      if (camera.port) from_.push_back(sight.from);
    }
  }
}

// A ray s·d meets the plane where n·(s·d − t) = 0, so s = n·t / n·d, and there u, v are ratios of
// linear forms of d: exact perspective, three dot products and a division a pixel.
Surface::Surface(const SceneObject& object, const Texture& texture,
                 const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation,
                 const Intrinsics& camera, const Float4& shade)
    : texture_(&texture),
      tiled_(object.tile_m > 0),
      shade_(shade),
      distance_m_(translation.norm()),
      columns_(camera.width) {
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  const Eigen::Vector3d n = r.col(2);
  const double c = n.dot(translation);
  const double w = tiled_ ? object.tile_m : object.size_m.x();
  const double h = tiled_ ? object.tile_m : object.size_m.y();
  const Eigen::Vector3d u = c / w * r.col(0) + (0.5 - r.col(0).dot(translation) / w) * n;
  const Eigen::Vector3d v = c / h * r.col(1) + (0.5 - r.col(1).dot(translation) / h) * n;
  const Eigen::Vector3f uf = u.cast<float>(), vf = v.cast<float>(), nf = n.cast<float>();
  ux_ = uf.x(), uy_ = uf.y(), uz_ = uf.z();
  vx_ = vf.x(), vy_ = vf.y(), vz_ = vf.z();
  nx_ = nf.x(), ny_ = nf.y(), nz_ = nf.z();
  c_ = static_cast<float>(c);
  if (camera.port) set_port(*camera.port, r, w, h);
  bound(object, rotation, translation, camera);
}

// From f·a instead of 0 (a: the port's axis) the line meets the plane at s = (n·t − f n·a) / n·d:
// u, v and z are what they were, and f times another ratio of linear forms of d.
void Surface::set_port(const FlatPort& port, const Eigen::Matrix3d& r, double w, double h) {
  const Eigen::Vector3d& a = port.normal;
  const Eigen::Vector3d n = r.col(2);
  const auto put = [&](const Eigen::Vector3d& form, float* out) {
    for (int k = 0; k < 3; ++k) out[k] = static_cast<float>(form[k]);
  };
  put((r.col(0).dot(a) * n - n.dot(a) * r.col(0)) / w, port_u_);
  put((r.col(1).dot(a) * n - n.dot(a) * r.col(1)) / h, port_v_);
  put(a.z() * n - n.dot(a) * Eigen::Vector3d::UnitZ(), port_z_);
  has_port_ = true;
  dry_m_ = static_cast<float>(port.distance_m + port.thickness_m);
}

// The rectangle of pixels that can be touched: all of them unless the whole outline is in front.
void Surface::bound(const SceneObject& object, const Eigen::Quaterniond& rotation,
                    const Eigen::Vector3d& translation, const Intrinsics& camera) {
  constexpr int kSteps = 8;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  bool whole = tiled_;
  for (int i = 0; i < 4 * kSteps && !whole; ++i) {
    const double along = static_cast<double>(i % kSteps) / kSteps - 0.5;
    const double side = i / kSteps % 2 ? 0.5 : -0.5;
    const Eigen::Vector2d p =
        i < 2 * kSteps ? Eigen::Vector2d(along, side) : Eigen::Vector2d(side, -along);
    const Eigen::Vector3d at(p.x() * object.size_m.x(), p.y() * object.size_m.y(), 0);
    const Eigen::Vector3d point = rotation * at + translation;
    const auto pixel = camera.project(point);
    if (!pixel || point.z() < 2 * double{kNearest_m})
      whole = true;
    else
      low = low.cwiseMin(*pixel), high = high.cwiseMax(*pixel);
  }
  if (whole) low.setZero(), high = Eigen::Vector2d(camera.width, camera.height);
  const double margin = 2 + 0.01 * (high - low).maxCoeff();  // edges bow where a lens distorts
  const auto inside = [&](double x, int size) {
    return static_cast<int>(std::clamp(x, 0.0, static_cast<double>(size)));
  };
  first_column_ = inside(low.x() - margin, camera.width);
  end_column_ = inside(high.x() + margin + 1, camera.width);
  first_row_ = inside(low.y() - margin, camera.height);
  end_row_ = inside(high.y() + margin + 1, camera.height);
}

void Surface::set_caustics(const Caustics& caustics, const SceneObject& object) {
  caustics_ = caustics;
  const Eigen::Matrix3d r = object.pose.rotation.toRotationMatrix();
  const double w = tiled_ ? object.tile_m : object.size_m.x();
  const double h = tiled_ ? object.tile_m : object.size_m.y();
  for (int axis = 0; axis < 2; ++axis) {  // the net lies on the world's x, y
    const double per_u = r(axis, 0) * w, per_v = r(axis, 1) * h;
    const double at_0 = object.pose.translation[axis] - 0.5 * (per_u + per_v);
    world_[axis][0] = static_cast<float>(per_u) * caustics.per_metre;
    world_[axis][1] = static_cast<float>(per_v) * caustics.per_metre;
    world_[axis][2] = static_cast<float>(at_0) * caustics.per_metre;
  }
}

Surface::Footprint Surface::footprint(const SightTable& sights, int column, int row) const {
  const SightTable::Run run = sights.run(column, row);
  const Hit here = hit(run[0]);
  const Hit right = hit(run[1]);
  const Hit below = hit(sights.run(column, row + 1)[0]);
  Footprint f = {{static_cast<float>(texture_->levels()), 1, 0, 0}, splat(1)};
  if (!is_drawn(here.depth) || !is_drawn(right.depth) || !is_drawn(below.depth)) return f;
  const float ux = right.u - here.u, uy = below.u - here.u;
  const float vx = right.v - here.v, vy = below.v - here.v;
  const float width_u = std::sqrt(ux * ux + uy * uy) + 1e-12f;
  const float width_v = std::sqrt(vx * vx + vy * vy) + 1e-12f;
  // The pixel's ellipse in texels: J Jᵀ = [a b; b d], its eigenvalues are the squared half axes.
  const float w = static_cast<float>(texture_->width()), h = static_cast<float>(texture_->height());
  const float a = w * w * width_u * width_u, d = h * h * width_v * width_v;
  const float b = w * h * (ux * vx + uy * vy);
  const float middle = 0.5f * (a + d);
  const float spread = std::sqrt(0.25f * (a - d) * (a - d) + b * b);
  const float longest = std::sqrt(middle + spread);
  const float most = tiled_ ? kProbesOfTile : kProbesOfPicture;
  const float shortest = std::max(std::sqrt(std::max(middle - spread, 0.0f)), longest / most);
  const float probes = std::clamp(longest / std::max(shortest, 1.0f), 1.0f, most);
  // Eigenvector of the long axis, the better conditioned of the two ways to write it.
  const float ex = a >= d ? middle + spread - d : b;
  const float ey = a >= d ? b : middle + spread - a;
  const float scale = longest / std::max(std::sqrt(ex * ex + ey * ey), 1e-20f);
  f.filter = Float4{log2_of(shortest), probes, ex * scale / w, ey * scale / h};
  f.edge = Float4{width_u, width_v, 1, 1};
  return f;
}

inline Float4 Surface::look(Float4 place, float level) const {
  if (tiled_) {
    place -= __builtin_convertvector(__builtin_convertvector(place, Int4), Float4);
    place = place < splat(0) ? place + splat(1) : place;
  } else {
    place = min4(max4(place, splat(0)), splat(1));
  }
  return texture_->sample(place, level);
}

inline Float4 Surface::filtered(float u, float v, Float4 filter) const {
  const Float4 place = {u, v, u, v};
  if (filter[1] < 1.6f) return look(place, filter[0]);
  const int probes = static_cast<int>(filter[1] + 0.4f);
  const Float4 axis = {filter[2], filter[3], filter[2], filter[3]};
  Float4 sum = splat(0);
  for (int i = 0; i < probes; ++i) {
    const float at = (static_cast<float>(i) + 0.5f) / static_cast<float>(probes) - 0.5f;
    sum += look(place + axis * splat(at), filter[0]);
  }
  return sum * (1.0f / static_cast<float>(probes));
}

// The share of the pixel inside the rectangle: distance to each edge in pixels, ramp of one pixel.
inline float Surface::border(float u, float v, Float4 edge) {
  const float across = std::min(u, 1 - u) / edge[0] + 0.5f;
  const float down = std::min(v, 1 - v) / edge[1] + 0.5f;
  return std::clamp(across, 0.0f, 1.0f) * std::clamp(down, 0.0f, 1.0f);
}

// Two layers of the pattern that move apart; where both are bright the net is.
float Surface::gathered(float u, float v) const {
  const float x = world_[0][0] * u + world_[0][1] * v + world_[0][2];
  const float y = world_[1][0] * u + world_[1][1] * v + world_[1][2];
  float least = 1;
  for (const auto& shift : caustics_.shift) {
    const float a = x + shift[0], b = y + shift[1];
    least = std::min(least, caustics_.pattern->sample(a - static_cast<float>(floor_int(a)),
                                                      b - static_cast<float>(floor_int(b)), 0)[0]);
  }
  return 1 + caustics_.strength * (4 * least - 1);
}

void Surface::draw_run(const SightTable::Run& sights, int count, const Footprint& a,
                       const Footprint& b, const WaterTable& water, Float4* out) const {
  for (int i = 0; i < count; ++i) {
    const Sight sight = sights[i];
    const Hit at = hit(sight);
    if (!is_drawn(at.depth)) continue;
    const float t = static_cast<float>(i) * (1.0f / kRun);
    const Float4 filter = a.filter + (b.filter - a.filter) * t;
    const float share = tiled_ ? 1.0f : border(at.u, at.v, a.edge + (b.edge - a.edge) * t);
    if (share <= 0) continue;
    Float4 light = filtered(at.u, at.v, filter) * shade_ * share;
    if (caustics_.pattern) {
      const float g = gathered(at.u, at.v);
      light *= Float4{g, g, g, 1};
    }
    const float range_m =
        (at.depth - dry_m_) * std::sqrt((sight.x * sight.x + sight.y * sight.y) + 1);
    out[i] = water.seen(light, range_m) + out[i] * splat(1 - light[3]);
  }
}

void Surface::draw_row(const SightTable& sights, int row, const WaterTable& water,
                       Float4* out) const {
  if (row < first_row_ || row >= end_row_ || first_column_ >= end_column_) return;
  const int start = first_column_ / kRun * kRun;  // nodes at the same columns in every row
  Footprint left = footprint(sights, start, row);
  for (int column = start; column < end_column_; column += kRun) {
    Footprint right = footprint(sights, std::min(column + kRun, columns_ - 1), row);
    const Float4 same = left.filter * right.filter;  // the axis has no sign of its own
    if (same[2] + same[3] < 0) right.filter *= Float4{1, 1, -1, -1};
    draw_run(sights.run(column, row), std::min(kRun, columns_ - column), left, right, water,
             out + column);
    left = right;
  }
}

float Surface::opaque_depth(const Sight& sight) const {
  const Hit at = hit(sight);
  if (!is_drawn(at.depth)) return 0;
  if (tiled_) return at.depth;
  if (at.u < 0 || at.u > 1 || at.v < 0 || at.v > 1) return 0;
  return texture_->sample(at.u, at.v, 0)[3] > 0.5f ? at.depth : 0;
}

}  // namespace gannet::world

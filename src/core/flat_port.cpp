#include "src/core/flat_port.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gannet {
namespace {

using Eigen::Vector3d;

struct Layer {
  double depth, index;  // along the axis
};
using Layers = std::array<Layer, 3>;

Layers layers_of(const FlatPort& port, double water_m) {
  return {{{port.distance_m, port.air_index},
           {port.thickness_m, port.glass_index},
           {water_m, port.water_index}}};
}

// Tangent of a ray's angle to the axis where the index is n; s = n · sine, the same in all layers.
double tangent(double s, double n) { return s / std::sqrt(n * n - s * s); }

// The s with which a ray ends so far from the axis.
//
// How far it ends, R(s) = Σ depth · tangent, grows and is convex, so Newton's method started where
// R is too large comes down to the root without ever passing it. Two such starts: each term is at
// least depth · s / index, and R at least any one term.
double invariant(const Layers& layers, double from_axis) {
  double paraxial = 0;
  for (const Layer& l : layers) paraxial += l.depth / l.index;
  double s = from_axis / paraxial;
  for (const Layer& l : layers)
    if (l.depth > 0) s = std::min(s, l.index * from_axis / std::hypot(from_axis, l.depth));
  for (int i = 0; i < 100; ++i) {
    double reached = 0, slope = 0;
    for (const Layer& l : layers) {
      if (!(l.depth > 0)) continue;
      const double cosine2 = l.index * l.index - s * s;
      reached += l.depth * s / std::sqrt(cosine2);
      slope += l.depth * l.index * l.index / (cosine2 * std::sqrt(cosine2));
    }
    const double next = s - (reached - from_axis) / slope;
    if (!(next < s) || !(next > 0)) break;  // as near as doubles come
    s = next;
  }
  return s;
}

}  // namespace

std::optional<Vector3d> FlatPort::air_ray(const Vector3d& point) const {
  const double along = normal.dot(point);
  const double water_m = along - distance_m - thickness_m;
  if (!(water_m > 0)) return std::nullopt;
  const Vector3d across = point - along * normal;
  const double from_axis = across.norm();
  if (!(from_axis > 1e-12)) return normal;
  const double s = invariant(layers_of(*this, water_m), from_axis);
  if (!(s < air_index)) return std::nullopt;  // the glass touches the camera's centre
  return normal + across * (tangent(s, air_index) / from_axis);
}

std::optional<Line> FlatPort::line(const Vector3d& air_ray) const {
  const double along = normal.dot(air_ray);
  if (!(along > 0)) return std::nullopt;
  const Vector3d across = air_ray / along - normal;
  const double air_tangent = across.norm();
  if (!(air_tangent > 1e-12)) {
    if (!(normal.z() > 1e-6)) return std::nullopt;
    return Line{(distance_m + thickness_m) * normal, normal / normal.z()};
  }
  const double s = air_index * air_tangent / std::hypot(1.0, air_tangent);
  if (!(s < glass_index) || !(s < water_index)) return std::nullopt;
  const Vector3d outwards = across / air_tangent;
  const double reached = distance_m * air_tangent + thickness_m * tangent(s, glass_index);
  const Vector3d direction = normal + outwards * tangent(s, water_index);
  if (!(direction.z() > 1e-6)) return std::nullopt;
  return Line{(distance_m + thickness_m) * normal + outwards * reached, direction / direction.z()};
}

double FlatPort::pupil_m() const {
  return distance_m + thickness_m -
         water_index * (distance_m / air_index + thickness_m / glass_index);
}

}  // namespace gannet

#include "tests/report/conditions.hpp"

#include <cstdio>

namespace gannet::robustness {

Conditions Plane::at(int cell) const {
  const auto i = static_cast<std::size_t>(cell);
  Conditions out;
  out.*x.value = x.steps[i % x.steps.size()];
  out.*y.value = y.steps[i / x.steps.size()];
  return out;
}

std::span<const Plane> planes() {
  static const Axis light = {"light", "lx", &Conditions::light_lux, {400, 50, 10, 3, 1}};
  static const Axis turbidity = {"turbidity c", "1/m", &Conditions::turbidity_per_m, {0, 1, 2, 3}};
  static const Axis occlusion = {
      "occluded share", "", &Conditions::occlusion, {0, 0.15, 0.3, 0.45, 0.6}};
  static const Axis distractors = {"distractors", "", &Conditions::distractors, {0, 2, 4, 8}};
  static const Axis distance = {
      "distance", "m", &Conditions::distance_m, {0.45, 0.55, 0.65, 0.8, 0.95}};
  static const Axis tilt = {"tilt", "°", &Conditions::tilt_deg, {0, 13, 26, 38}};
  static const Axis blur = {"blur", "px", &Conditions::blur_px, {0.5, 1, 2, 4}};
  static const std::vector<Plane> all = {{"water", light, turbidity},
                                         {"clutter", occlusion, distractors},
                                         {"pose", distance, tilt},
                                         {"blur", light, blur}};
  return all;
}

std::string step_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace gannet::robustness

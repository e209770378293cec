// What makes a target hard to see, as numbers, and the planes through that space which the
// robustness report measures: two conditions vary over a plane, the others stay at their usual
// value. Report only, any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace gannet::robustness {

struct Conditions {
  double light_lux = 400;      // on the target
  double turbidity_per_m = 1;  // c: attenuation of green light; 0: air
  double occlusion = 0;        // share of the target's box behind something nearer
  double blur_px = 0.5;        // standard deviation, in both images
  double distance_m = 0.6;     // of the target, along the optical axis
  double tilt_deg = 15;        // of the target's normal from that axis
  double distractors = 2;      // other creatures behind the target
};

struct Axis {
  const char* name;
  const char* unit;
  double Conditions::*value;
  std::vector<double> steps;  // easy first
};

struct Plane {
  const char* name;  // one word, for --only
  Axis x, y;
  int cells() const { return static_cast<int>(x.steps.size() * y.steps.size()); }
  Conditions at(int cell) const;  // row by row, x varies first
};

std::span<const Plane> planes();
std::string step_text(double value);  // without zeros at its end

}  // namespace gannet::robustness

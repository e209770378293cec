// Parameters of the pose filter, described once. Start-up only.
#pragma once

#include "platform/base/describe.hpp"

namespace gannet::track {

struct FilterConfig {
  bool predict = true;  // false: the pose at capture is passed on unchanged
  // Spectral densities of the white acceleration: m/s²/√Hz and rad/s²/√Hz.
  double acceleration_density = 0.1;
  double angular_acceleration_density = 0.3;
  double initial_speed_m_s = 0.3;  // standard deviations at the first measurement
  double initial_rate_rad_s = 0.5;
  double least_sigma_m = 0.0002;  // a measurement is never trusted beyond this
  double least_sigma_rad = 0.001;
  double gate = 35;                 // largest squared Mahalanobis distance, 6 degrees of freedom
  int rejections_to_reset = 5;      // in a row
  double longest_gap_s = 1;         // between measurements; beyond it the filter starts anew
  double longest_prediction_s = 2;  // beyond it there is no valid prediction
};

void describe(Visitor& v, FilterConfig& c);

}  // namespace gannet::track

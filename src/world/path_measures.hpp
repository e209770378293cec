// What a run's paths say: where the target was in the hand, how far from the goal on average, and
// how the held place (the point before the hand that is to coincide with the target) answers the
// target's sines. Millimetres, degrees, hertz; NaN where a run cannot say. Measures of check.hpp
// and of the papers' experiments. Pure; any thread.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "src/world/check.hpp"
#include "src/world/trace.hpp"

namespace gannet::world {

// axis: 0 x, 1 y, 2 z of the hand.
double mean_place_mm(const Trace& trace, const Window& window, int axis);
double mean_absolute_error_mm(const Trace& trace, const Window& window, int axis);
// Likewise, of what a mission had arrived at.
double visit_absolute_error_mm(const Trace& trace, const Window& window, int axis);
int visits_done(const Trace& trace, const Window& window);
struct Reach {
  double least_mm, most_mm;
};
Reach distance_reach_mm(const Trace& trace, const Window& window);  // the target's z in the hand

// Least fitness of the found frames as a share of the median of the run's first 30.
double fitness_kept(const Trace& trace, const Window& window);

// Held place over target at one frequency along an axis of the reference hand, both by least
// squares with mean, sine and cosine. Exact over whole periods.
std::complex<double> response_at(const Trace& trace, const Window& window, int axis,
                                 double frequency_hz);
double lag_deg(const Trace& trace, const Window& window, int axis, double frequency_hz);

// The response at a multisine's frequencies (motion.hpp), over the window's whole periods.
struct Bode {
  std::vector<double> frequency_hz, gain, phase_deg;  // phase without jumps
};
Bode bode(const Trace& trace, const Window& window, int axis);
// Where the gain first falls below 1/√2, where the phase first falls below −90°: linear over the
// logarithm of frequency; the sweep's last frequency where it never does.
double cutoff_hz(const Bode& bode);
double quarter_hz(const Bode& bode);

int frames_heard(const Trace& trace, const Window& window);

}  // namespace gannet::world

#include "src/world/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "src/world/texture.hpp"

namespace gannet::world {
namespace {

constexpr int kCurve = 16384;  // 0.2 of a code apart where the curve is steepest
constexpr int kQuantiles = 4096;
constexpr double kPhotonsPerLuxSecond = 4.09e15;  // per m², 555 nm

double electrons_per_lux_second(const SensorConfig& c) {
  const double area_m2 = c.pixel_um * c.pixel_um * 1e-12;
  return c.lens_transmission / (4 * c.f_number * c.f_number) * area_m2 * c.electrons_per_photon *
         kPhotonsPerLuxSecond;
}

double normal_quantile(double p) {  // by bisection: made once, exact enough for a float
  double low = -6;
  double high = 6;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::vector<float> normal_quantiles() {
  std::vector<double> q(kQuantiles);
  double squares = 0;
  for (int i = 0; i < kQuantiles / 2; ++i) {
    const double x = normal_quantile((i + 0.5) / kQuantiles);
    q[static_cast<std::size_t>(i)] = x;
    q[static_cast<std::size_t>(kQuantiles - 1 - i)] = -x;
    squares += 2 * x * x;
  }
  const double scale = std::sqrt(kQuantiles / squares);  // the cut tails, given back
  std::vector<float> out(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) out[i] = static_cast<float>(q[i] * scale);
  return out;
}

}  // namespace

void describe(Visitor& v, SensorConfig& c) {
  v.field("f_number", c.f_number, {.min = 0.5, .max = 64, .help = "Of the lens."});
  v.field("lens_transmission", c.lens_transmission,
          {.min = 0.01, .max = 1, .help = "Share of the light that passes the lens."});
  v.field("pixel_um", c.pixel_um,
          {.min = 0.5, .max = 50, .unit = "um", .help = "Side of a pixel."});
  v.field("electrons_per_photon", c.electrons_per_photon,
          {.min = 0.001, .max = 1, .help = "Quantum efficiency behind the colour filters."});
  v.field("full_well_electrons", c.full_well_electrons,
          {.min = 100, .max = 1e6, .help = "Electrons at the end of the range at gain 1."});
  v.field("read_noise_electrons", c.read_noise_electrons,
          {.min = 0, .max = 1000, .help = "Standard deviation of the read-out."});
  v.field("max_exposure_s", c.max_exposure_s,
          {.min = 1e-6, .max = 1, .unit = "s", .help = "Longest exposure; gain follows."});
  v.field("max_gain", c.max_gain, {.min = 1, .max = 1000, .help = "Largest gain."});
  v.field(
      "white_level", c.white_level,
      {.min = 0.01, .max = 4, .help = "Share of the range that a white surface is exposed to."});
  v.field("noise", c.noise, {.help = "Shot and read noise."});
}

Exposure expose(const SensorConfig& c, double lux) {
  const double electrons_per_second = electrons_per_lux_second(c) * std::max(lux, 1e-9);
  const double wanted = c.white_level * c.full_well_electrons;
  Exposure e;
  e.exposure_s = std::min(c.max_exposure_s, wanted / electrons_per_second);
  e.electrons_at_white = electrons_per_second * e.exposure_s;
  e.gain = std::clamp(wanted / e.electrons_at_white, 1.0, c.max_gain);
  e.level_at_white = e.electrons_at_white * e.gain / c.full_well_electrons;
  return e;
}

Sensor::Sensor(const SensorConfig& config, double lux)
    : config_(config), curve_(kCurve + 1), normal_(normal_quantiles()) {
  for (int i = 0; i <= kCurve; ++i) {
    curve_[static_cast<std::size_t>(i)] =
        static_cast<float>(255 * srgb_from_linear(static_cast<double>(i) / kCurve));
  }
  set_light(lux);
}

void Sensor::set_light(double lux) {
  exposure_ = expose(config_, lux);
  electrons_ = static_cast<float>(exposure_.electrons_at_white);
  read_variance_ = static_cast<float>(config_.read_noise_electrons * config_.read_noise_electrons);
  signal_ = static_cast<float>(exposure_.gain / config_.full_well_electrons);
}

Float4 Sensor::noise(std::uint64_t bits) const {
  const auto q = [&](int shift) { return normal_[(bits >> shift) & (kQuantiles - 1)]; };
  return Float4{q(0), q(16), q(32), 0};
}

void Sensor::develop(const Float4* light, Float4* codes, int count, std::uint64_t key) const {
  const float scale = signal_ * kCurve;
  for (int i = 0; i < count; ++i) {
    Float4 electrons = max4(light[i], splat(0)) * electrons_;
    if (config_.noise) {
      const Float4 variance = electrons + read_variance_;
      const Float4 sigma = {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2]),
                            0};
      electrons += sigma * noise(hashed(key, static_cast<std::uint64_t>(i)));
    }
    const Float4 level =
        min4(max4(electrons * scale + splat(0.5f), splat(0)), splat(static_cast<float>(kCurve)));
    const Int4 at = __builtin_convertvector(level, Int4);
    codes[i] =
        Float4{curve_[static_cast<std::size_t>(at[0])], curve_[static_cast<std::size_t>(at[1])],
               curve_[static_cast<std::size_t>(at[2])], 0};
  }
}

double Sensor::code(double x) const { return 255 * srgb_from_linear(x * exposure_.level_at_white); }

double Sensor::sigma(double x) const {
  return double{signal_} * std::sqrt(x * double{electrons_} + double{read_variance_});
}

}  // namespace gannet::world

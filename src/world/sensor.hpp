// Sensor: from light on the scene to coded pixels, by counting electrons.
//   electrons(x) = x · lux · exposure · k,  x = light seen, 1 = a white surface under `lux`
//   k = T / (4 N²) · A · Q · 4.09e15 electrons per lux-second of scene, where 4.09e15 photons of
//   555 nm per lux-second and m² follow from 683 lm/W; T transmission of the lens, N f-number, A
//   area of a pixel, Q electrons per photon in each colour channel, white-balanced.
// Noise is normal with variance electrons + read²: shot noise (its Poisson law is close to normal
// above some ten electrons) and read noise, white over pixels, channels, eyes and frames. The
// signal clips at the full well divided by the gain, is coded with the sRGB curve and then turned
// to YUV with 8 bits. Auto exposure knows the light: longest exposure first, then gain, so that x =
// 1 reaches `white_level`; when both are at their limits the picture is dark, as in real life.
//
// Defaults: the class of a VGA global-shutter machine-vision sensor with 6 µm pixels behind an f/2
// lens; 1/40 s is what 30 Hz leave beside the read-out.
// Any thread; a value after creation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/world/simd.hpp"

namespace gannet::world {

struct SensorConfig {
  double f_number = 2.0;
  double lens_transmission = 0.9;
  double pixel_um = 6.0;
  double electrons_per_photon = 0.3;  // colour filter and quantum efficiency
  double full_well_electrons = 12000;
  double read_noise_electrons = 12;
  double max_exposure_s = 1.0 / 40;
  double max_gain = 24;
  double white_level = 0.8;  // share of the range that x = 1 is exposed to
  bool noise = true;
};
void describe(Visitor& v, SensorConfig& c);

struct Exposure {
  double exposure_s = 0;
  double gain = 1;
  double electrons_at_white = 0;  // of x = 1
  double level_at_white = 0;      // signal of x = 1; 1 is the end of the range
};

// Exposure for a scene under lux > 0.
Exposure expose(const SensorConfig& config, double lux);

class Sensor {
 public:
  explicit Sensor(const SensorConfig& config, double lux = 400);
  void set_light(double lux);  // exposes anew

  const Exposure& exposure() const { return exposure_; }

  // Codes 0 … 255 (with fractions) of R, G, B for a row of `count` pixels. key: anything unique to
  // seed, frame, eye and row; the same key gives the same noise. light and codes may be the same.
  void develop(const Float4* light, Float4* codes, int count, std::uint64_t key) const;

  // Expected code of light x without noise, and the signal's standard deviation (1 = whole range).
  double code(double x) const;
  double sigma(double x) const;

 private:
  Float4 noise(std::uint64_t bits) const;

  SensorConfig config_;
  Exposure exposure_;
  float electrons_ = 0;        // of x = 1
  float read_variance_ = 0;    // electrons²
  float signal_ = 0;           // of one electron
  std::vector<float> curve_;   // codes by signal, kCurve + 1 entries
  std::vector<float> normal_;  // quantiles of the normal law, 2¹² entries, variance 1
};

// A 64-bit value that looks random for each (key, counter): splitmix64's finaliser.
inline std::uint64_t hashed(std::uint64_t key, std::uint64_t counter) {
  std::uint64_t z = key + counter * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

}  // namespace gannet::world

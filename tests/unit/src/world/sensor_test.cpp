#include "src/world/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "src/world/texture.hpp"

namespace gannet::world {
namespace {

// Mean and variance of the linear signal (1 = whole range) of one channel, from its codes.
struct Moments {
  double mean = 0;
  double variance = 0;
};
Moments developed(const Sensor& sut, float x, int channel) {
  constexpr int kCount = 40000;
  std::vector<Float4> pixels(kCount, Float4{x, x, x, 1});
  sut.develop(pixels.data(), pixels.data(), kCount, 77);
  double sum = 0, squares = 0;
  for (const Float4& p : pixels) {
    const double signal = double{linear_from_srgb(p[channel] / 255)};
    sum += signal, squares += signal * signal;
  }
  const double mean = sum / kCount;
  return {mean, squares / kCount - mean * mean};
}

TEST(Sensor, NoiseHasTheVarianceOfElectronsPlusReadNoise) {
  for (const double lux : {3.0, 50.0, 1000.0}) {
    const Sensor sut(SensorConfig{}, lux);
    for (const double x : {0.2, 0.5, 0.8}) {
      const Exposure& e = sut.exposure();
      const double per_electron = e.gain / SensorConfig{}.full_well_electrons;
      const double electrons = x * e.electrons_at_white;
      const double expected = per_electron * per_electron * (electrons + 12 * 12);
      for (int channel = 0; channel < 3; ++channel) {
        const Moments m = developed(sut, static_cast<float>(x), channel);
        EXPECT_NEAR(m.mean, electrons * per_electron, 0.002) << lux << " lx, " << x;
        EXPECT_NEAR(m.variance, expected, 0.04 * expected) << lux << " lx, " << x;
      }
    }
  }
}

TEST(Sensor, ChannelsAndNeighboursAreNotAlike) {
  const Sensor sut(SensorConfig{}, 10);
  std::vector<Float4> p(20000, Float4{0.4f, 0.4f, 0.4f, 1});
  sut.develop(p.data(), p.data(), 20000, 5);
  double mean = 0, variance = 0, channels = 0, neighbours = 0;
  for (const Float4& x : p) mean += double{x[0]} / 20000;
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double a = double{p[i][0]} - mean;
    variance += a * a;
    channels += a * (double{p[i][1]} - mean);
    neighbours += a * (double{p[i - 1][0]} - mean);
  }
  EXPECT_LT(std::abs(channels / variance), 0.03);
  EXPECT_LT(std::abs(neighbours / variance), 0.03);
}

TEST(Sensor, DarknessIsMetWithExposureThenGainThenNotAtAll) {
  const SensorConfig config;
  const Exposure bright = expose(config, 5000);
  EXPECT_LT(bright.exposure_s, config.max_exposure_s);
  EXPECT_EQ(bright.gain, 1);
  EXPECT_NEAR(bright.level_at_white, config.white_level, 1e-12);
  const Exposure dim = expose(config, 60);
  EXPECT_EQ(dim.exposure_s, config.max_exposure_s);
  EXPECT_GT(dim.gain, 1);
  EXPECT_NEAR(dim.level_at_white, config.white_level, 1e-12);
  const Exposure dark = expose(config, 1);
  EXPECT_EQ(dark.gain, config.max_gain);
  EXPECT_LT(dark.level_at_white, config.white_level / 2);
}

TEST(Sensor, WithoutNoiseItIsTheCurveAndClips) {
  SensorConfig config;
  config.noise = false;
  const Sensor sut(config, 400);
  for (const double x : {0.0, 0.003, 0.1, 0.5, 1.0, 5.0}) {
    const float f = static_cast<float>(x);
    Float4 pixel = {f, f, f, 1};
    sut.develop(&pixel, &pixel, 1, 0);
    EXPECT_NEAR(double{pixel[1]}, sut.code(x), 0.15) << x;
  }
}

TEST(Sensor, TheKeyAloneDecidesTheNoise) {
  const Sensor sut(SensorConfig{}, 20);
  const std::vector<Float4> light(64, splat(0.5f));
  std::vector<Float4> a(64), b(64), c(64);
  sut.develop(light.data(), a.data(), 64, 1);
  sut.develop(light.data(), b.data(), 64, 1);
  sut.develop(light.data(), c.data(), 64, 2);
  int different = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    EXPECT_EQ(a[i][0], b[i][0]);
    different += a[i][0] != c[i][0];
  }
  EXPECT_GT(different, 50);
}

}  // namespace
}  // namespace gannet::world

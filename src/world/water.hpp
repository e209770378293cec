// Water: what the path from a surface to the camera does to its light, per channel in linear light:
//   I = J·exp(−β_D·r) + B·(1 − exp(−β_B·r))   (Akkaynak & Treibitz, CVPR 2018 and 2019)
// r is the distance along the line of sight in metres, J the surface's light, B the veiling light
// as the colour of endless water; both in units of a white surface under the scene's light.
// WaterTable holds it by distance; linear in between, 1e-4 of the true value. Any thread.
#pragma once

#include <array>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/world/simd.hpp"

namespace gannet::world {

struct Water {
  std::vector<double> attenuation_per_m = {0, 0, 0};  // β_D of R, G, B
  std::vector<double> backscatter_per_m = {0, 0, 0};  // β_B of R, G, B
  std::vector<double> veil = {0, 0, 0};               // B of R, G, B

  bool operator==(const Water&) const = default;
};
void describe(Visitor& v, Water& c);

// Named waters for scenarios and tests; exact figures in water.cpp. Air is Water{}.
Water pool_water();
Water coastal_water();
Water turbid_water();

class WaterTable {
 public:
  explicit WaterTable(const Water& water);

  // Premultiplied light of a surface at range_m, as it reaches the camera; alpha stays.
  Float4 seen(Float4 light, float range_m) const {
    const float at = range_m * kEntriesPerMetre;
    const int i = at < kEntries - 1 ? static_cast<int>(at) : kEntries - 1;
    const float t = at < kEntries - 1 ? at - static_cast<float>(i) : 0;
    const Entry& a = entries_[static_cast<std::size_t>(i)];
    const Entry& b = entries_[static_cast<std::size_t>(i) + 1];
    const Float4 transmission = a.transmission + (b.transmission - a.transmission) * t;
    const Float4 veil = a.veil + (b.veil - a.veil) * t;
    return light * transmission + veil * splat(light[3]);
  }
  Float4 endless() const { return endless_; }  // where the ray meets nothing; alpha 0

  static constexpr int kEntries = 2048;
  static constexpr float kEntriesPerMetre = 128;  // farther than 16 m: as at 16 m

 private:
  struct Entry {
    Float4 transmission;
    Float4 veil;
  };
  std::vector<Entry> entries_;
  Float4 endless_;
};

}  // namespace gannet::world

#include "src/world/water.hpp"

#include <cmath>

namespace gannet::world {

void describe(Visitor& v, Water& c) {
  v.field("attenuation_per_m", c.attenuation_per_m,
          {.min = 0, .max = 100, .size = 3, .unit = "1/m", .help = "β_D of red, green, blue."});
  v.field("backscatter_per_m", c.backscatter_per_m,
          {.min = 0, .max = 100, .size = 3, .unit = "1/m", .help = "β_B of red, green, blue."});
  v.field("veil", c.veil,
          {.min = 0,
           .max = 1,
           .size = 3,
           .help = "Light of endless water in red, green, blue; 1 is a lit white surface."});
}

// Pure water's absorption over R, G, B is about 0.35, 0.06, 0.02 per metre (Pope & Fry 1997 near
// 620, 540 and 460 nm); pool water adds a little scatter. Coastal and turbid water follow the
// order of Jerlov's types 3C and 9C (Solonenko & Mobley 2015), where blue dies first.
Water pool_water() { return {{0.38, 0.09, 0.06}, {0.10, 0.11, 0.12}, {0.03, 0.10, 0.13}}; }
Water coastal_water() { return {{0.60, 0.30, 0.38}, {0.40, 0.42, 0.45}, {0.06, 0.17, 0.16}}; }
Water turbid_water() { return {{1.60, 1.25, 1.50}, {1.30, 1.35, 1.45}, {0.13, 0.24, 0.19}}; }

WaterTable::WaterTable(const Water& water) : entries_(kEntries + 1), endless_(splat(0)) {
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    for (int i = 0; i <= kEntries; ++i) {
      const double range_m = std::min(i, kEntries - 1) / double{kEntriesPerMetre};
      Entry& entry = entries_[static_cast<std::size_t>(i)];
      entry.transmission[c] =
          static_cast<float>(std::exp(-water.attenuation_per_m[channel] * range_m));
      entry.veil[c] = static_cast<float>(
          water.veil[channel] * (1 - std::exp(-water.backscatter_per_m[channel] * range_m)));
    }
    endless_[c] = static_cast<float>(water.veil[channel]);
  }
  for (Entry& entry : entries_) entry.transmission[3] = 1, entry.veil[3] = 0;
}

}  // namespace gannet::world

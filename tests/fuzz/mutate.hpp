// Mutates good inputs as a fuzzer does, but always the same way: for the unit tests, so that what
// the fuzz targets see is tried in `make check` as well.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "platform/base/random.hpp"

namespace gannet {

// One to four of: a flipped bit, a random or extreme byte, a cut, a repeated or removed stretch.
inline std::vector<std::uint8_t> mutated(std::vector<std::uint8_t> bytes, Random& random) {
  const auto position = [&] { return random.below(static_cast<int>(bytes.size())); };
  for (int changes = 1 + random.below(4); changes > 0 && !bytes.empty(); --changes) {
    const auto at = static_cast<std::size_t>(position());
    const auto length = static_cast<std::ptrdiff_t>(
        random.below(static_cast<int>(std::min<std::size_t>(bytes.size() - at, 64)) + 1));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    switch (random.below(6)) {
      case 0:
        bytes[at] ^= static_cast<std::uint8_t>(1 << random.below(8));
        break;
      case 1:
        bytes[at] = static_cast<std::uint8_t>(random.below(256));
        break;
      case 2:
        bytes[at] = random.below(2) == 0 ? 0x00 : 0xff;
        break;
      case 3:
        bytes.resize(at);
        break;
      case 4: {
        const std::vector<std::uint8_t> stretch(begin, begin + length);
        bytes.insert(begin, stretch.begin(), stretch.end());
        break;
      }
      default:
        bytes.erase(begin, begin + length);
        break;
    }
  }
  return bytes;
}

// Runs the target on the seeds as they are and on `count` mutations of them.
template <class Target>
void run_mutations(const std::vector<std::vector<std::uint8_t>>& seeds, int count, Target target) {
  Random random(2024);
  for (const auto& seed : seeds) target(seed.data(), seed.size());
  for (int i = 0; i < count; ++i) {
    const auto& seed =
        seeds[static_cast<std::size_t>(random.below(static_cast<int>(seeds.size())))];
    const auto input = mutated(seed, random);
    target(input.data(), input.size());
  }
}

}  // namespace gannet

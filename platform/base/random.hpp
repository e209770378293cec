// Random: xoshiro256++ with splitmix64 seeding. Same numbers on every machine, no libm, no heap.
// A value; RT safe.
#pragma once

#include <cstdint>

namespace gannet {

class Random {
 public:
  explicit Random(std::uint64_t seed = 1) { this->seed(seed); }

  void seed(std::uint64_t seed) {
    for (auto& s : state_) {
      seed += 0x9e3779b97f4a7c15u;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      s = z ^ (z >> 31);
    }
  }
  std::uint64_t next() {
    const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t t = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = rotate(state_[3], 45);
    return result;
  }
  // [0, 1), 24 and 53 bits.
  float uniform_f() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  // 0 … n − 1; the bias of the multiplication is below 2⁻³² for n < 2³².
  int below(int n) {
    return static_cast<int>(((next() >> 32) * static_cast<std::uint64_t>(n)) >> 32);
  }
  // Mean 0, variance 1: the sum of twelve uniforms, exact in float arithmetic, tails to ±6.
  float normal_f() {
    float sum = -6;
    for (int i = 0; i < 12; ++i) sum += uniform_f();
    return sum;
  }

 private:
  static std::uint64_t rotate(std::uint64_t x, int k) { return (x << k) | (x >> (64 - k)); }
  std::uint64_t state_[4] = {};
};

}  // namespace gannet

// A NumPy array file (.npy, versions 1 to 3) of 32-bit little-endian floats with two dimensions,
// as disparities are published. Any bytes may be given. Error: path and what is wrong.
// Source: NumPy Enhancement Proposal 1. Normal thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::tool {

struct FloatMap {
  int width = 0;
  int height = 0;
  std::vector<float> values;  // row by row; what is unknown is not finite

  float at(int x, int y) const {
    return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

Result<FloatMap> decode_npy(std::span<const std::uint8_t> bytes, const std::string& path);
Result<FloatMap> read_npy(const std::string& path);

}  // namespace gannet::tool

// Raster: pixels as a PNG has them, for what is not a picture of a camera: masks, stamps with
// alpha, maps, reliefs. Rows tight, channels interleaved. A value; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gannet::image_file {

template <class Sample>
struct Raster {
  int width = 0;
  int height = 0;
  int channels = 0;  // 1 grey, 3 RGB, 4 RGBA (alpha straight, not premultiplied)
  std::vector<Sample> samples;

  Raster() = default;
  Raster(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        samples(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                static_cast<std::size_t>(c)) {}

  Sample* at(int x, int y) { return samples.data() + index(x, y); }
  const Sample* at(int x, int y) const { return samples.data() + index(x, y); }

 private:
  std::size_t index(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
            static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

using Raster8 = Raster<std::uint8_t>;
using Raster16 = Raster<std::uint16_t>;

}  // namespace gannet::image_file

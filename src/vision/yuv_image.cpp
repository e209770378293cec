#include "src/vision/yuv_image.hpp"

#include <algorithm>
#include <cmath>

#include "src/vision/yuv_rows.hpp"

namespace gannet::vision {
namespace {

YuvImage make(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height))};
}

// Sliding mean along one direction; step is the distance of neighbours in bytes.
void blur_line(const std::uint8_t* from, int n, std::ptrdiff_t step, int radius, std::uint8_t* to) {
  const auto at = [&](int i) { return static_cast<int>(from[std::clamp(i, 0, n - 1) * step]); };
  const int size = 2 * radius + 1;
  int sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += at(i);
  for (int i = 0; i < n; ++i) {
    to[i * step] = static_cast<std::uint8_t>((sum + size / 2) / size);
    sum += at(i + radius + 1) - at(i - radius);
  }
}

}  // namespace

YuvImage to_yuv(const hal::ImageView& view) {
  YuvImage out = make(view.width, view.height);
  const auto n = static_cast<std::size_t>(view.width) + 1;
  std::vector<std::uint8_t> y(n), u(n), v(n);
  for (int row = 0; row < view.height; ++row) {
    unpack_row(view, row, y.data(), u.data(), v.data());
    for (int i = 0; i < view.width; ++i) {
      std::uint8_t* p = out.at(i, row);
      p[0] = y[static_cast<std::size_t>(i)];
      p[1] = u[static_cast<std::size_t>(i)];
      p[2] = v[static_cast<std::size_t>(i)];
    }
  }
  return out;
}

YuvImage undistorted(YuvImage image, const Intrinsics& camera, double depth_m) {
  if (camera.distortion == Distortion::kNone && !camera.port) return image;
  const Eigen::Vector2d f = camera.magnification();
  YuvImage out = make(image.width, image.height);
  for (int row = 0; row < out.height; ++row) {
    for (int col = 0; col < out.width; ++col) {
      std::uint8_t* p = out.at(col, row);
      p[1] = p[2] = 128;
      const Eigen::Vector3d ray((col - camera.cx) / f.x(), (row - camera.cy) / f.y(), 1);
      const auto pixel = camera.project(depth_m * ray);
      if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > image.width - 1 ||
          pixel->y() > image.height - 1) {
        continue;
      }
      const int x = std::min(static_cast<int>(pixel->x()), image.width - 2);
      const int y = std::min(static_cast<int>(pixel->y()), image.height - 2);
      const double a = pixel->x() - x;
      const double b = pixel->y() - y;
      for (int c = 0; c < 3; ++c) {
        const double top = (1 - a) * image.at(x, y)[c] + a * image.at(x + 1, y)[c];
        const double bottom = (1 - a) * image.at(x, y + 1)[c] + a * image.at(x + 1, y + 1)[c];
        p[c] = static_cast<std::uint8_t>(std::lround((1 - b) * top + b * bottom));
      }
    }
  }
  return out;
}

YuvImage box_blurred(const YuvImage& image, int radius) {
  if (radius <= 0) return image;
  YuvImage across = make(image.width, image.height);
  YuvImage out = make(image.width, image.height);
  for (int c = 0; c < 3; ++c) {
    for (int row = 0; row < image.height; ++row) {
      blur_line(image.at(0, row) + c, image.width, 3, radius, across.at(0, row) + c);
    }
    for (int col = 0; col < image.width; ++col) {
      blur_line(across.at(col, 0) + c, image.height, 3 * image.width, radius, out.at(col, 0) + c);
    }
  }
  return out;
}

}  // namespace gannet::vision

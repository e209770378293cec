#include "src/vision/silhouette.hpp"

#include <algorithm>
#include <cmath>

namespace gannet::vision {
namespace {

constexpr int kSmooth = 2;       // pixels; takes the noise out of the differences
constexpr double kStrong = 2.0;  // seeds of the target, in thresholds

// Difference of two pixels in grey levels; chroma counts more, so that a shadow counts less.
double difference(const std::uint8_t* a, const std::uint8_t* b) {
  const double dy = 0.6 * (a[0] - b[0]);
  const double du = 1.5 * (a[1] - b[1]);
  const double dv = 1.5 * (a[2] - b[2]);
  return std::sqrt(dy * dy + du * du + dv * dv);
}

// Labels 4-connected pieces of the pixels that take() accepts, from seed on; returns its pixels.
template <class Take>
std::vector<int> flood(int seed, int width, int height, std::vector<bool>& seen, Take take) {
  std::vector<int> piece;
  if (seen[static_cast<std::size_t>(seed)] || !take(seed)) return piece;
  seen[static_cast<std::size_t>(seed)] = true;
  piece.push_back(seed);
  for (std::size_t next = 0; next < piece.size(); ++next) {
    const int at = piece[next];
    const int x = at % width;
    const int y = at / width;
    const int neighbours[4] = {x > 0 ? at - 1 : -1, x + 1 < width ? at + 1 : -1,
                               y > 0 ? at - width : -1, y + 1 < height ? at + width : -1};
    for (const int n : neighbours) {
      if (n < 0 || seen[static_cast<std::size_t>(n)] || !take(n)) continue;
      seen[static_cast<std::size_t>(n)] = true;
      piece.push_back(n);
    }
  }
  return piece;
}

std::vector<int> largest_piece(const std::vector<double>& d, int width, int height, double weak) {
  std::vector<bool> seen(d.size());
  std::vector<int> best;
  for (int i = 0; i < width * height; ++i) {
    if (d[static_cast<std::size_t>(i)] < kStrong * weak) continue;
    auto piece = flood(i, width, height, seen,
                       [&](int at) { return d[static_cast<std::size_t>(at)] >= weak; });
    if (piece.size() > best.size()) best = std::move(piece);
  }
  return best;
}

}  // namespace

std::vector<std::uint8_t> find_silhouette(const YuvImage& photo, const YuvImage& background) {
  const int width = photo.width;
  const int height = photo.height;
  const YuvImage a = box_blurred(photo, kSmooth);
  const YuvImage b = box_blurred(background, kSmooth);
  std::vector<double> d(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < d.size(); ++i) {
    d[i] = difference(a.yuv.data() + 3 * i, b.yuv.data() + 3 * i);
  }
  // Most of the photo is background: the median is what noise does.
  std::vector<double> sorted = d;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(d.size() / 2),
                   sorted.end());
  const double weak = std::max(8.0, 5 * sorted[d.size() / 2]);

  std::vector<std::uint8_t> mask(d.size(), 0);
  const std::vector<int> piece = largest_piece(d, width, height, weak);
  if (piece.empty()) return {};
  for (const int i : piece) mask[static_cast<std::size_t>(i)] = 255;
  // Scan inwards from the edge: what cannot be reached without crossing the piece belongs to it.
  std::vector<bool> seen(d.size());
  const auto open = [&](int at) { return mask[static_cast<std::size_t>(at)] == 0; };
  for (int x = 0; x < width; ++x) {
    flood(x, width, height, seen, open);
    flood((height - 1) * width + x, width, height, seen, open);
  }
  for (int y = 0; y < height; ++y) {
    flood(y * width, width, height, seen, open);
    flood(y * width + width - 1, width, height, seen, open);
  }
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!seen[i]) mask[i] = 255;
  }
  return mask;
}

}  // namespace gannet::vision

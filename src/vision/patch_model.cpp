#include "src/vision/patch_model.hpp"

#include <algorithm>
#include <cmath>

#include "src/vision/hue_value.hpp"
#include "src/vision/silhouette.hpp"
#include "src/vision/symmetry.hpp"
#include "src/vision/yuv_image.hpp"

namespace gannet::vision {
namespace {

struct Box {
  int left, top, right, bottom;  // inclusive
};

Box bounding_box(const std::vector<std::uint8_t>& mask, int width, int height) {
  Box box = {width, height, -1, -1};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (mask[static_cast<std::size_t>(y * width + x)] == 0) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x),
             std::max(box.bottom, y)};
    }
  }
  return box;
}

Yuv mean_colour(const std::vector<Yuv>& colours) {
  double y = 0, u = 0, v = 0;
  for (const Yuv& c : colours) {
    y += c.y;
    u += c.u;
    v += c.v;
  }
  const auto n = static_cast<double>(std::max<std::size_t>(colours.size(), 1));
  return {static_cast<float>(y / n), static_cast<float>(u / n), static_cast<float>(v / n)};
}

Yuv colour_of(const std::uint8_t* p) {
  return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
}

Error problem(const std::string& name, const std::string& text) {
  return {(name.empty() ? "target photo" : name) + ": " + text};
}

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

std::optional<Error> check_input(const PhotoInput& input, const Intrinsics& camera) {
  const hal::ImageView& photo = input.target;
  if (!(input.distance_m > 0) || !std::isfinite(input.distance_m)) {
    return problem(input.name, "the distance to the target must be more than 0 mm");
  }
  if (photo.width != camera.width || photo.height != camera.height) {
    return problem(input.name, "the photo is " + size_text(photo.width, photo.height) +
                                   " but the left camera is " +
                                   size_text(camera.width, camera.height) + " pixels");
  }
  for (const hal::ImageView* other : {input.background, input.mask}) {
    if (other == nullptr) continue;
    if (other->width == photo.width && other->height == photo.height) continue;
    return problem(input.name, std::string(other == input.mask ? "the mask" : "the background") +
                                   " is " + size_text(other->width, other->height) +
                                   " but the photo is " + size_text(photo.width, photo.height));
  }
  if (input.background == nullptr && input.mask == nullptr) {
    return problem(input.name, "give a background photo or a mask (--background, --mask)");
  }
  return std::nullopt;
}

struct Silhouette {
  std::vector<std::uint8_t> mask;
  std::vector<Yuv> background;  // its colours
};

Result<Silhouette> silhouette_of(const PhotoInput& input, const YuvImage& photo,
                                 const Intrinsics& camera) {
  Silhouette out;
  std::optional<YuvImage> background;
  if (input.background != nullptr)
    background = undistorted(to_yuv(*input.background), camera, input.distance_m);
  if (input.mask != nullptr) {
    const YuvImage mask = undistorted(to_yuv(*input.mask), camera, input.distance_m);
    out.mask.resize(mask.yuv.size() / 3);
    for (std::size_t i = 0; i < out.mask.size(); ++i) out.mask[i] = mask.yuv[3 * i] > 0 ? 255 : 0;
  } else {
    if (background->yuv == photo.yuv) {
      return problem(input.name, "the background photo equals the target photo");
    }
    out.mask = find_silhouette(photo, *background);
  }
  const auto inside = std::count(out.mask.begin(), out.mask.end(), 255);
  if (out.mask.empty() || inside < 64) {
    return problem(input.name,
                   "no target was found: the silhouette is empty or smaller than 64 "
                   "pixels; check mask or background");
  }
  if (inside == static_cast<std::ptrdiff_t>(out.mask.size())) {
    return problem(input.name, "the mask covers the whole photo; it must leave some background");
  }
  for (std::size_t i = 0; i < out.mask.size(); ++i) {
    if (background) {
      out.background.push_back(colour_of(background->yuv.data() + 3 * i));
    } else if (out.mask[i] == 0) {
      out.background.push_back(colour_of(photo.yuv.data() + 3 * i));
    }
  }
  return out;
}

}  // namespace

Result<PhotoPatch> cut_out(const PhotoInput& input, const Intrinsics& camera) {
  if (auto bad = check_input(input, camera)) return *bad;
  const YuvImage photo = undistorted(to_yuv(input.target), camera, input.distance_m);
  auto silhouette = silhouette_of(input, photo, camera);
  if (!silhouette) return silhouette.error();
  const std::vector<std::uint8_t>& mask = silhouette->mask;

  const Box box = bounding_box(mask, photo.width, photo.height);
  const auto inside = static_cast<double>(std::count(mask.begin(), mask.end(), 255));
  const int margin = static_cast<int>(std::ceil(0.4 * std::sqrt(inside))) + 4;
  const Box crop = {std::max(box.left - margin, 0), std::max(box.top - margin, 0),
                    std::min(box.right + margin, photo.width - 1),
                    std::min(box.bottom + margin, photo.height - 1)};
  PhotoPatch patch;
  patch.name = input.name;
  patch.width = crop.right - crop.left + 1;
  patch.height = crop.bottom - crop.top + 1;
  for (int y = crop.top; y <= crop.bottom; ++y) {
    for (int x = crop.left; x <= crop.right; ++x) {
      patch.yuv.insert(patch.yuv.end(), photo.at(x, y), photo.at(x, y) + 3);
      patch.mask.push_back(mask[static_cast<std::size_t>(y * photo.width + x)]);
    }
  }
  patch.distance_m = input.distance_m;
  const Eigen::Vector2d f = camera.magnification();
  patch.fx = f.x();
  patch.fy = f.y();
  const Eigen::Vector2d corner(crop.left, crop.top);
  patch.centre_px = Eigen::Vector2d(box.left + box.right, box.top + box.bottom) / 2 - corner;
  if (input.origin_px) {
    const Line sight = camera.line(*input.origin_px).value_or(Line{});
    const Eigen::Vector2d at = sight.at_depth(input.distance_m).head<2>() / input.distance_m;
    patch.centre_px = f.cwiseProduct(at) + Eigen::Vector2d(camera.cx, camera.cy) - corner;
    const bool is_near = patch.centre_px.x() >= 0 && patch.centre_px.x() <= patch.width - 1 &&
                         patch.centre_px.y() >= 0 && patch.centre_px.y() <= patch.height - 1;
    if (!is_near) return problem(input.name, "the origin must lie on the target or close to it");
  }
  patch.size_m = {(box.right - box.left + 1) * input.distance_m / f.x(),
                  (box.bottom - box.top + 1) * input.distance_m / f.y()};
  patch.background = mean_colour(silhouette->background);
  patch.background_hue = mean_hue(silhouette->background);
  return patch;
}

// What a pixel of the frame is blurred with lies within three of the photo: frames are taken from
// up to twice as far away, and smoothed by a pixel.
constexpr int kFrameBlurPx = 3;

// Whether the silhouette reaches so far all around.
bool surrounded(const PhotoPatch& photo, int x, int y, int reach) {
  if (x < reach || y < reach || x + reach >= photo.width || y + reach >= photo.height) return false;
  for (int row = y - reach; row <= y + reach; ++row) {
    const auto first = photo.mask.begin() + row * photo.width + x - reach;
    if (std::find(first, first + 2 * reach + 1, 0) != first + 2 * reach + 1) return false;
  }
  return true;
}

Result<PatchModel> make_patch_model(const PhotoPatch& photo, const BuildOptions& options) {
  const double pixel_x = photo.distance_m / photo.fx;
  const double pixel_y = photo.distance_m / photo.fy;
  const auto inside = static_cast<double>(photo.mask.size()) -
                      static_cast<double>(std::count(photo.mask.begin(), photo.mask.end(), 0));
  PatchModel model;
  model.name = photo.name;
  model.size_m = photo.size_m;
  model.eye_m = {0, 0, -photo.distance_m};
  model.background = photo.background;
  model.background_hue = photo.background_hue;
  model.symmetry = symmetry_of(photo);
  model.spacing_m = std::sqrt(inside * pixel_x * pixel_y / options.inside_points);

  const YuvImage image = {photo.width, photo.height, photo.yuv};
  const int radius = std::max(0, static_cast<int>(model.spacing_m / pixel_x / 2));
  const YuvImage means = box_blurred(image, radius);
  const double band =
      std::max(options.band * std::sqrt(inside * pixel_x * pixel_y), 1.5 * model.spacing_m);

  std::vector<ModelPoint> out;
  const int columns = static_cast<int>(photo.width * pixel_x / model.spacing_m) + 1;
  const int rows = static_cast<int>(photo.height * pixel_y / model.spacing_m) + 1;
  for (int row = -rows; row <= rows; ++row) {
    for (int column = -columns; column <= columns; ++column) {
      ModelPoint p;
      p.x_m = static_cast<float>((column + 0.5) * model.spacing_m);
      p.y_m = static_cast<float>((row + 0.5) * model.spacing_m);
      const auto x =
          static_cast<int>(std::lround(photo.centre_px.x() + static_cast<double>(p.x_m) / pixel_x));
      const auto y =
          static_cast<int>(std::lround(photo.centre_px.y() + static_cast<double>(p.y_m) / pixel_y));
      if (x < 0 || y < 0 || x >= photo.width || y >= photo.height) continue;
      // Where that pixel's centre is: half a pixel beside it would cost a slope's worth of colour.
      p.x_m = static_cast<float>((x - photo.centre_px.x()) * pixel_x);
      p.y_m = static_cast<float>((y - photo.centre_px.y()) * pixel_y);
      p.inside = photo.mask[static_cast<std::size_t>(y * photo.width + x)] != 0;
      p.border = p.inside && !surrounded(photo, x, y, radius + kFrameBlurPx);
      p.colour = colour_of(means.at(x, y));
      (p.inside ? model.points : out).push_back(p);
    }
  }
  model.inside_count = static_cast<int>(model.points.size());
  if (model.inside_count < 16) {
    return problem(photo.name, "the silhouette gives only " + std::to_string(model.inside_count) +
                                   " points; 16 are needed");
  }
  for (const ModelPoint& p : out) {
    const auto near = [&](const ModelPoint& in) {
      return std::hypot(static_cast<double>(in.x_m - p.x_m), static_cast<double>(in.y_m - p.y_m)) <=
             band;
    };
    if (std::any_of(model.points.begin(), model.points.begin() + model.inside_count, near)) {
      model.points.push_back(p);
    }
  }
  return model;
}

}  // namespace gannet::vision

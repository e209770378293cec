// PatchModel: what is known of a target's look: points on its plane with their colours (P001 §2.2,
// P002 §II-A). S_in lies on the target, S_out is the band around it. Colours are full-range BT.601
// YUV; hue and value follow from them (hue_value.hpp). Built once, read by every fitness; coarse
// levels are derived, never stored. Building is start-up only (heap); reading is RT safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera/image_view.hpp"
#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"

namespace gannet::vision {

struct Yuv {
  float y = 0;    // 0 … 255
  float u = 128;  // centred on 128
  float v = 128;
};

struct ModelPoint {
  float x_m = 0;       // on the target's plane: right on the photo
  float y_m = 0;       // down on the photo
  bool inside = true;  // S_in, else S_out
  Yuv colour;          // S_out: of the photo's own surroundings there
  // Of S_in: so near to the outline that the surroundings of the photo are blurred into its colour.
  bool border = false;
};

// A rectangle of whole pixels in the left image.
struct Rectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

// Turns about the target's normal after which it looks the same (symmetry.hpp).
struct Symmetry {
  bool any_roll = false;           // then rolls is empty
  std::vector<double> rolls = {};  // radians in (0, π]; a roll and its opposite are one
  bool exists() const { return any_roll || !rolls.empty(); }
};

struct PatchModel {
  std::string name;
  Eigen::Vector2d size_m = Eigen::Vector2d::Zero();  // bounding box of S_in
  double spacing_m = 0;                              // of the grid of points
  Eigen::Vector3d eye_m = {0, 0, -1e6};  // where the photo was taken from, in the target's frame
  std::vector<ModelPoint> points;        // S_in first
  int inside_count = 0;
  Yuv background;                   // mean of the background
  std::uint8_t background_hue = 0;  // chroma-weighted circular mean, 256 steps
  Symmetry symmetry = {};           // none of what a rectangle became
};

// A photo of the target with its silhouette, as a model file holds it. Pixels are the crop's.
struct PhotoPatch {
  std::string name;
  int width = 0;  // of the crop, pixels
  int height = 0;
  std::vector<std::uint8_t> yuv;   // width·height·3, full-range BT.601, interleaved Y U V
  std::vector<std::uint8_t> mask;  // width·height, non-zero = S_in
  double distance_m = 0;           // from the camera's centre to the target's plane, along z
  double fx = 0;                   // of the camera that took it, pixels
  double fy = 0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // target's origin in the crop
  Eigen::Vector2d size_m = Eigen::Vector2d::Zero();
  Yuv background;
  std::uint8_t background_hue = 0;
};

struct BuildOptions {
  int inside_points = 800;  // wanted number of S_in points; the grid's spacing follows
  double band = 0.22;       // width of S_out as a share of √(area of S_in)
};

// Samples the photo on a regular grid. Error: empty silhouette, too few points.
Result<PatchModel> make_patch_model(const PhotoPatch& photo, const BuildOptions& options);

// Where the target is in a photo. background and mask: at least one; mask non-zero = target.
struct PhotoInput {
  hal::ImageView target;
  const hal::ImageView* background = nullptr;
  const hal::ImageView* mask = nullptr;  // its Y plane counts
  double distance_m = 0.4;
  std::string name;
  // The target's origin, pixels of the photo. Nothing: the middle of the silhouette's box.
  std::optional<Eigen::Vector2d> origin_px = std::nullopt;
};

// Finds the silhouette (scan from the four corners against the background's mean hue, P001 §2.2,
// or the mask) and crops. Errors: sizes differ, background equals target, empty silhouette,
// distance not positive, an origin away from the target.
Result<PhotoPatch> cut_out(const PhotoInput& input, const Intrinsics& camera);

}  // namespace gannet::vision

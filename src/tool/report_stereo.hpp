// ReportStereo: what `gannet locate --roi` found in a real pair, beside the depth that the pair's
// published disparity says. A folder holds
//   rig.toml, left.png, right.png     the pair, rectified
//   disparity.npy                     of the left image, pixels; not finite where unknown
//   rectangles.csv                    name,x,y,width,height (pixels of the left image)
//   NAME.json                         the answer of locate --json for each of them
// Normal thread.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hal/camera/image.hpp"
#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/report/table.hpp"
#include "src/tool/report_npy.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::tool {

// The plane that fits the disparities in a rectangle best.
struct TruePlane {
  double depth_m = 0;        // at the rectangle's centre
  Eigen::Vector3d normal;    // away from the camera, in its frame
  double residual_px = 0;    // rms of the disparities from the plane's
  double slant_deg() const;  // of the normal from the optical axis
};
// Error: the pair is not rectified, the disparity is known in less than half of the rectangle.
Result<TruePlane> plane_of(const FloatMap& disparity, const vision::Rectangle& rectangle,
                           const StereoRig& rig);

struct StereoAnswer {
  std::string name;
  vision::Rectangle rectangle;
  TruePlane truth;
  bool found = false;
  Transform<LeftCamera, Target> pose;
  double sigma_z_m = 0;
  double fitness = 0;
  double time_ms = 0;

  double depth_error() const;  // relative to the true depth
  double angle_deg() const;    // between the normals
  bool passed() const;         // found, and the depth within kDepthLimit
};
inline constexpr double kDepthLimit = 0.05;

struct ReportStereo {
  StereoRig rig;
  std::vector<StereoAnswer> answers;
  hal::Image picture;  // both images with the planes found

  bool passed() const;
  report::Table table() const;
};

// Error: which file is missing or wrong.
Result<ReportStereo> read_stereo(const std::string& folder);

}  // namespace gannet::tool

// Sums of the refinement: what one pass of Gauss–Newton gathers over the points of one eye, one
// table of functions per instruction set. Eight points side by side in float, each lane with sums
// of its own that are added in a fixed order at the end, so that every table gives the same bits.
// RT safe.
#pragma once

#include <cstdint>

namespace gannet::vision {

constexpr int kSumLanes = 8;

// What a channel's previous pass found: residual = image − gain · model − offset.
struct ChannelFit {
  float gain = 0;
  float offset = 0;
  float weight_scale = 0;  // Cauchy: weight / (1 + residual² · weight_scale); 0: no weighing
};

// One eye at one pose. Points are m = (x, y, 1); camera = h · m, and z · deep where there is a z.
struct RefineEye {
  float h[9];      // rows: X, Y, Z in the camera's axes
  float deep[3];   // away from the plane
  float arm[9];    // columns of the lever arm x · a + y · b + z · c in the left camera's axes
  float turn[9];   // left from this camera, row by row
  float plane[3];  // unscaled targets: n / d of the plane, for which m is a left camera's ray
  float fx, fy, cx, cy;
  const std::uint8_t* smooth[3];  // planes Y U V
  int width, height;
  ChannelFit fit[3];
};

// A lens moves the points: pixels and their slopes by normalised coordinates, one for each point of
// the part; a pixel that is not a number is outside.
struct LensPart {
  const float* u;
  const float* v;
  const float* slopes[4];  // du/da, du/db, dv/da, dv/db
};

// Points of S_in or of S_out: n is a multiple of kSumLanes, padding has NaN coordinates.
struct RefinePart {
  const float* x;
  const float* y;
  const float* z;       // of points that lie off the plane; null: flat
  const float* colour;  // Y U V interleaved
  int n;
  float weight;
  const LensPart* lens;  // null: a pinhole
};

// Of one channel: Σw Σwm Σwm² Σwi Σwim Σwi² (i and m less 128), then P each of Σwj Σwmj Σwij, then
// the lower half of Σwjjᵀ column by column.
constexpr int sums_of(int parameters) {
  return 6 + 3 * parameters + parameters * (parameters + 1) / 2;
}

// As many for each of three channels, kSumLanes each.
template <int kParameters>
struct RefineSums {
  alignas(32) float lanes[3][sums_of(kParameters)][kSumLanes] = {};
};

struct RefineKernels {
  const char* name;
  // Adds a part. Six parameters: translation and small rotation of points on the target's plane, in
  // the left camera's axes. Three: n / d of the plane seen along rays of the left camera.
  void (*add_pose)(const RefineEye& eye, const RefinePart& part, RefineSums<6>& sums);
  void (*add_plane)(const RefineEye& eye, const RefinePart& part, RefineSums<3>& sums);
};

extern const RefineKernels kScalarRefineKernels;
extern const RefineKernels kAvx2RefineKernels;  // x86-64 only

// The best table that this processor has; the same bits whichever it is.
const RefineKernels& refine_kernels();

}  // namespace gannet::vision

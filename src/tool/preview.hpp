// Pictures by which people check what the program understood: a model's preview and the overlay of
// a found target on its images. Normal thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "hal/camera/image.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::tool {

// A piece of an outline on the target's plane, metres.
struct Segment {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

// The border of the mask, pixel edge by pixel edge.
std::vector<Segment> outline_of(const vision::PhotoPatch& patch);

// The rectangle's edges on the plane at this pose.
std::vector<Segment> outline_of(const vision::Rectangle& rectangle, const Intrinsics& left,
                                const Transform<LeftCamera, Target>& pose);

// The crop, enlarged, with the outline and the points (on the target green, around it blue).
hal::Image draw_preview(const vision::PhotoPatch& patch, const vision::PatchModel& model);

// Left and right image side by side, with the outline and the target's axes (x red, y green, z
// blue) as long as axis_m.
hal::Image draw_overlay(const hal::Image& left, const hal::Image& right, const StereoRig& rig,
                        const Transform<LeftCamera, Target>& pose,
                        const std::vector<Segment>& outline, double axis_m);

}  // namespace gannet::tool

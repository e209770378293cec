// A RIG file: the calibration of two cameras as TOML. Start-up only.
//
//   [left]                       # and [right]
//   width = 640                  # pixels; (0, 0) is the centre of the first one
//   height = 480
//   fx = 640.0
//   fy = 640.0
//   cx = 319.5
//   cy = 239.5
//   distortion = "none"          # none | brown (k1 k2 p1 p2 k3) | fisheye (k1 k2 k3 k4)
//   coefficients = []
//   [right_from_left]            # r_right = R r_left + t, rotation row by row
//   rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
//   translation_m = [-0.12, 0, 0]
//
// Optional: time_offset_s of a camera; [hand_from_left] and [body_from_hand] in the same form.
// Without [hand_from_left] the hand is midway between the cameras, with the axes of the left one.
//
//   [left.port]                  # optional, and [right.port]: the flat port of a housing
//   normal = [0, 0, 1]           # unit, into the water, in the camera's optical axes
//   distance_m = 0.025           # from the camera's centre to the glass, along the normal
//   thickness_m = 0.01
//   water_index = 1.333          # and air_index = 1, glass_index = 1.49
#pragma once

#include <string>
#include <string_view>

#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"

namespace gannet::config {

// Errors name file and line; all at once.
Result<StereoRig> load_rig(const std::string& path);
Result<StereoRig> parse_rig(std::string_view text, const std::string& name);

// What load_rig reads as the same rig, but for time offsets of less than a nanosecond.
std::string rig_text(const StereoRig& rig);

// The keys of the file as Markdown.
std::string rig_reference();

}  // namespace gannet::config

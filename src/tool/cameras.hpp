// `gannet cameras`: the V4L2 devices of this machine with what they offer, in the words that the
// config uses. Opens each for a moment and changes nothing; a daemon that streams is not disturbed.
// Normal thread.
#pragma once

#include <string>
#include <vector>

#include "hal/camera/v4l2_controls.hpp"
#include "hal/camera/v4l2_offer.hpp"
#include "src/control/json.hpp"
#include "src/tool/subcommands.hpp"

namespace gannet::tool {

struct FoundCamera {
  std::string path;                // /dev/video0
  std::vector<std::string> links;  // names that stay the same: /dev/v4l/by-path/…
  hal::V4l2Offer offer;
  std::vector<hal::V4l2Control> controls;
  std::string problem;  // why it could not be read; then the rest is empty
};

FoundCamera look_at(hal::V4l2System& system, const std::string& path);

control::Json json_of(const std::vector<FoundCamera>& cameras);
std::string text_of(const std::vector<FoundCamera>& cameras);

Subcommand cameras_subcommand();

}  // namespace gannet::tool

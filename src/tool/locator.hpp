// Locator: one stereo pair and what to look for in it, ready to be searched or scored; what
// `locate` and `map` share. Normal thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera/image.hpp"
#include "platform/base/command_line.hpp"
#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/tool/answer.hpp"
#include "src/tool/preview.hpp"
#include "src/track/recogniser.hpp"
#include "src/vision/prepared_frame.hpp"

namespace gannet::tool {

// --left and --right.
std::vector<Argument> pair_options();

class Locator {
 public:
  // By --rig, --left, --right, --model or --roi, and search_options(depths). Error: which of them
  // is wrong and how.
  static Result<Locator> create(const Arguments& arguments, const std::string& depths = "z-mm");

  Answer locate();

  const StereoRig& rig() const { return rig_; }
  std::vector<Segment> outline(const Transform<LeftCamera, Target>& pose) const;
  hal::Image overlay(const Transform<LeftCamera, Target>& pose,
                     const Eigen::Vector2d& size_m) const;

  track::Recogniser& recogniser() { return *recogniser_; }
  const vision::PreparedFrame& frame() const { return *frame_; }
  Parallel& workers() { return *workers_; }

 private:
  Locator() = default;
  Result<void> read_images(const Arguments& arguments);
  Result<void> choose_target(const Arguments& arguments, const track::TrackConfig& config);

  StereoRig rig_;
  hal::Image left_;
  hal::Image right_;
  std::optional<vision::PhotoPatch> patch_;
  std::optional<vision::Rectangle> rectangle_;
  std::unique_ptr<Parallel> workers_;
  std::unique_ptr<track::Recogniser> recogniser_;
  std::unique_ptr<vision::PreparedFrame> frame_;
  Duration preparation_ = {};
};

}  // namespace gannet::tool

// TargetTracker: all of recognition that the vision loop needs, in one object: it is given image
// pairs and answers with estimates. It holds the models, the prepared planes, the optimiser and
// the state searching → locked → coasting → lost. Knows no thread, file or clock.
// create() is start-up only; everything else belongs to the vision thread and is RT safe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera/image_view.hpp"
#include "platform/base/describe.hpp"
#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "src/core/pose_estimate.hpp"
#include "src/core/stereo_rig.hpp"
#include "src/track/recognition.hpp"
#include "src/vision/patch_model.hpp"

namespace gannet::track {

struct TrackConfig;  // track_config.hpp

class TargetTracker {
 public:
  static Result<std::unique_ptr<TargetTracker>> create(const TrackConfig& config,
                                                       const StereoRig& rig,
                                                       std::vector<vision::PatchModel> models);
  virtual ~TargetTracker() = default;

  // Chooses what to look for from the next frame on. id is the caller's, carried in estimates.
  // choose_model with an index that does not exist, or a rectangle outside the image, returns
  // false and leaves all as it was.
  virtual bool choose_model(int index, std::uint32_t id) = 0;
  virtual bool choose_rectangle(const vision::Rectangle& rectangle, std::uint32_t id) = 0;
  virtual void choose_none() = 0;

  // One pair → one estimate. Without a target it answers at once with kNoTarget.
  virtual PoseEstimate process(const hal::ImageView& left, const hal::ImageView& right,
                               TimePoint capture_time, std::uint64_t frame_number,
                               const Budget& budget, Parallel& parallel) = 0;

  // No pair has come; the state ages (coasting, then lost).
  virtual PoseEstimate no_frame(TimePoint now) = 0;
};

}  // namespace gannet::track

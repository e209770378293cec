// V4l2Camera: one or two V4L2 devices as a StereoCamera; v4l2_pair and v4l2_side_by_side make it.
// capture() polls the devices, takes what they have, pairs it, and hands it on: driver buffers as
// they are, or through the decoder. A device that is lost comes back by itself (V4l2Link); the
// other one goes on, so that it is not late when its twin is back.
// create and start are start-up only; capture belongs to the capture thread and is RT safe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera/mjpeg_decoder.hpp"
#include "hal/camera/stereo_camera.hpp"
#include "hal/camera/v4l2_link.hpp"
#include "hal/camera/v4l2_pair.hpp"

namespace gannet::hal {

class V4l2Camera final : public StereoCamera {
 public:
  struct Setting {
    std::vector<std::string> paths;  // left, right; or the one that has both side by side
    V4l2StreamConfig stream;
    Duration tolerance;
    bool right_first;
  };
  static Result<std::unique_ptr<StereoCamera>> create(const Setting& setting, DecodeImage decode,
                                                      V4l2System& system);

  int width() const override { return is_pair() ? full_width() : full_width() / 2; }
  int height() const override { return setting_.stream.height; }
  Result<void> start() override;
  CaptureStatus capture(TimePoint now, Duration timeout, StereoFrame& frame) override;
  CaptureCounters counters() const override;

 private:
  V4l2Camera(const Setting& setting, DecodeImage decode, V4l2System& system);
  bool is_pair() const { return links_.size() == 2; }
  int full_width() const { return setting_.stream.width; }

  CaptureStatus look(TimePoint now, StereoFrame& frame);
  CaptureStatus take_from_devices(TimePoint now);
  bool next_images(V4l2Images& images);
  CaptureStatus hand_on(V4l2Images images, StereoFrame& frame);
  CaptureStatus deliver(V4l2Images images, StereoFrame& frame);
  CaptureStatus deliver_decoded(MjpegDecoder::Decoded decoded, StereoFrame& frame);
  void set_views(const ImageView& first, const ImageView& second, StereoFrame& frame) const;
  void wait(TimePoint until);

  const Setting setting_;
  const DecodeImage decode_;
  V4l2System& system_;
  std::vector<std::unique_ptr<V4l2Link>> links_;
  std::unique_ptr<MjpegDecoder> decoder_;  // after the links: it holds their leases

  // Capture thread
  PairByTime pairing_;
  V4l2Image single_;  // of the one device, until it is handed on
  bool lost_ = false;
  CaptureCounters counters_;
};

}  // namespace gannet::hal

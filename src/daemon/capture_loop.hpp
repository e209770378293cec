// CaptureLoop: 1 waits for a pair and takes it  2 hands it to vision, or gives it back when vision
// has no room. Knows no thread: the same body runs live and stepped. Capture thread; RT safe.
#pragma once

#include "hal/camera/stereo_camera.hpp"
#include "platform/base/event.hpp"
#include "src/daemon/frame_line.hpp"
#include "src/daemon/messages.hpp"

namespace gannet::daemon {

class CaptureLoop {
 public:
  struct Links {
    hal::StereoCamera* camera;
    FrameLine* to_vision;
    LatestValue<CaptureReport>* report;
    EventPort* events;
    SharedFacts* facts;
  };

  // time_offset is added to the driver's stamp.
  CaptureLoop(const Links& links, Duration time_offset);

  hal::CaptureStatus step(TimePoint now, Duration timeout);

 private:
  enum Stage { kTake, kHandOn };
  void hand_on(TakenFrame&& frame, TimePoint now);
  void tell(hal::CaptureStatus status, TimePoint now);

  Links links_;
  const Duration time_offset_;
  CaptureReport report_;
  bool silent_ = false;
};

}  // namespace gannet::daemon

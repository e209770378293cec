// DriveGroup: the codec of all motors that share one protocol on one bus: frames in → feedback;
// setpoints → frames out. Knows no socket and no clock. Kinds are listed in drive_kinds.cpp.
// Used by the servo thread alone. RT safe after creation.
#pragma once

#include <cstdint>
#include <span>

#include "hal/can/can_frame.hpp"
#include "hal/drive/drive_values.hpp"
#include "platform/base/time.hpp"

namespace gannet::hal {

struct DriveGroupHealth {
  bool all_alive = false;  // each drive was heard within its feedback time-out
  bool any_fault = false;
  bool all_ready = true;      // each drive is set up and could be enabled
  bool guards_itself = true;  // each drive stops by itself when we fall silent, as far as the
                              // config wants that
  int first_bad = -1;  // motor index of the first one of which one of these is bad; −1: none
  const char* trouble = "";        // with first_bad, where the kind knows words: static text
  std::uint32_t trouble_code = 0;  // the protocol's number for it; 0: none
};

class DriveGroup {
 public:
  virtual ~DriveGroup() = default;

  virtual int size() const = 0;  // motors

  // Takes one frame from the bus. Frames of others are ignored, malformed ones counted.
  virtual void receive(const CanFrame& frame, TimePoint time) = 0;

  // Writes the frames that are due now: setpoints, heartbeats, requests, answers. With enable
  // false every motor is commanded to stop, whatever setpoints say. Returns how many frames were
  // written to out; out of at least max_frames() always suffices.
  virtual int send(std::span<const DriveSetpoint> setpoints, bool enable, TimePoint now,
                   std::span<CanFrame> out) = 0;
  virtual int max_frames() const = 0;

  virtual std::span<const DriveFeedback> feedback() const = 0;
  virtual DriveGroupHealth health(TimePoint now) const = 0;
  virtual std::uint64_t malformed() const = 0;

  // A person's reset: drives that latch their faults are led out of them, while not enabled.
  virtual void reset_faults(TimePoint) {}
};

}  // namespace gannet::hal

// Reports: the newest word of every loop and all events, kept for those who ask; and their JSON.
// Control thread.
#pragma once

#include <string>
#include <vector>

#include "src/control/json.hpp"
#include "src/daemon/messages.hpp"
#include "src/telemetry/event_store.hpp"

namespace gannet::daemon {

// What the loops write into.
struct ReportLines {
  LatestValue<CaptureReport> capture;
  LatestValue<VisionReport> vision;
  LatestValue<ServoReport> servo;
  EventPort capture_events, vision_events, servo_events, archive_events;
};

// The word that stands for a number in an event's text: {0:state}.
std::string word_of(std::string_view kind, int value);
const char* to_string(hal::BusState state);

class Reports {
 public:
  explicit Reports(ReportLines* lines) : lines_(lines) {}

  // Takes what the loops have told since the last call; events are also logged.
  void refresh();
  void add_event(const Event& event);

  const CaptureReport& capture() const { return *capture_; }
  const VisionReport& vision() const { return *vision_; }
  const ServoReport& servo() const { return *servo_; }

  control::Json estimate_json(const std::vector<std::string>& models, TimePoint now) const;
  control::Json target_json(const StereoRig& rig) const;  // predicted to the newest servo cycle
  control::Json events_json(std::uint64_t since, std::size_t most) const;
  control::Json loops_json() const;       // stages with last, mean, max, budget, percentiles
  control::Json histograms_json() const;  // frame → pose, frame → CAN …
  control::Json drops_json() const;
  control::Json cameras_json() const;  // what was wrong with images, the skew of pairs

 private:
  void drain(EventPort& port);
  ReportLines* lines_;
  const CaptureReport* capture_ = &lines_->capture.read();
  const VisionReport* vision_ = &lines_->vision.read();
  const ServoReport* servo_ = &lines_->servo.read();
  telemetry::EventStore events_;
};

}  // namespace gannet::daemon

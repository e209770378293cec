#include "src/telemetry/event_codes.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace gannet::telemetry {
namespace {

constexpr EventWords kTable[] = {
    {kStarted, Severity::kNotice, "started", "started"},
    {kStopping, Severity::kNotice, "stopping", "stopping"},
    {kRightsMissing, Severity::kWarning, "rights_missing", "real-time rights are missing"},
    {kStateChanged, Severity::kNotice, "state_changed", "{0:state} → {1:state} ({2:cause})"},
    {kRequestRefused, Severity::kWarning, "request_refused", "request refused: {0:cause}"},
    {kTrackChanged, Severity::kNotice, "track_changed", "track {0:track} ({1:reason}), target {2}"},
    {kFilterReset, Severity::kInfo, "filter_reset", "pose filter started anew, target {0}"},
    {kCameraSilent, Severity::kWarning, "camera_silent", "the cameras are silent"},
    {kCameraBack, Severity::kNotice, "camera_back", "the cameras are back"},
    {kCameraBroken, Severity::kWarning, "camera_broken", "pairs refused as broken: {0} so far"},
    {kCameraNoSlot, Severity::kWarning, "camera_no_slot", "pairs dropped for want of room: {0}"},
    {kReplayFinished, Severity::kNotice, "replay_finished", "the replay has no more pairs"},
    {kBusChanged, Severity::kWarning, "bus_changed", "CAN bus is {0:bus}"},
    {kDriveSilent, Severity::kError, "drive_silent", "motor {0} is not heard"},
    {kDriveFault, Severity::kError, "drive_fault", "motor {0} reports a fault (code {1:hex})"},
    {kDrivesGood, Severity::kNotice, "drives_good", "all motors are heard and without fault"},
    {kDriveRefused, Severity::kError, "drive_refused",
     "motor {0} refused its set-up (object {1:hex}); see gannet status"},
    {kEstopDiscrepancy, Severity::kError, "estop_discrepancy",
     "the e-stop's two contacts disagree: one of them or its wire is broken"},
    {kOverrun, Severity::kWarning, "overrun", "servo periods missed: {0}, {1} in all"},
    {kInternalFault, Severity::kCritical, "internal_fault", "internal fault at step {0}"},
    {kArchiveFailed, Severity::kError, "archive_failed", "frame {0} could not be recorded"},
    {kTargetChosen, Severity::kInfo, "target_chosen", "target {0} chosen"},
    {kGoalSet, Severity::kInfo, "goal_set", "goal [{0}, {1}, {2}] mm"},
    {kMissionChanged, Severity::kNotice, "mission_changed",
     "mission {0:mission}, visit {1} of {2}"},
    {kMissionTimedOut, Severity::kWarning, "mission_timed_out",
     "visit {0} of {1} took too long: nothing is followed until a person starts the mission again"},
};

std::string number_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

}  // namespace

std::span<const EventWords> event_table() { return kTable; }

const EventWords* words_of(EventCode code) {
  for (const EventWords& words : kTable) {
    if (words.code == code) return &words;
  }
  return nullptr;
}

Event make_event(EventCode code, TimePoint time, double a, double b, double c) {
  const EventWords* words = words_of(code);
  return {code, words == nullptr ? Severity::kError : words->severity, time, {a, b, c}};
}

std::string text_of(const Event& event, const WordOf& word_of) {
  const EventWords* words = words_of(event.code);
  if (words == nullptr) return "event " + std::to_string(static_cast<int>(event.code));
  std::string text;
  std::string_view rest = words->text;
  while (!rest.empty()) {
    const std::size_t open = rest.find('{');
    text += rest.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::size_t close = rest.find('}', open);
    const double value = event.args[static_cast<std::size_t>(rest[open + 1] - '0')];
    std::string word;
    if (rest[open + 2] == ':' && word_of && std::abs(value) < 1e6) {
      word = word_of(rest.substr(open + 3, close - open - 3), static_cast<int>(value));
    }
    text += word.empty() ? number_text(value) : word;
    rest.remove_prefix(close + 1);
  }
  return text;
}

}  // namespace gannet::telemetry

// Every event of the daemon: its code, severity, name and words, in one table. Threads raise codes
// and numbers; the control thread makes the words. Codes are RT safe, words are for the control
// thread.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "platform/base/event.hpp"

namespace gannet::telemetry {

inline constexpr EventCode kStarted{1};
inline constexpr EventCode kStopping{2};
inline constexpr EventCode kRightsMissing{3};
inline constexpr EventCode kStateChanged{10};
inline constexpr EventCode kRequestRefused{11};
inline constexpr EventCode kTrackChanged{20};
inline constexpr EventCode kFilterReset{21};
inline constexpr EventCode kCameraSilent{30};
inline constexpr EventCode kCameraBack{31};
inline constexpr EventCode kCameraBroken{32};
inline constexpr EventCode kCameraNoSlot{33};
inline constexpr EventCode kReplayFinished{34};
inline constexpr EventCode kBusChanged{40};
inline constexpr EventCode kDriveSilent{41};
inline constexpr EventCode kDriveFault{42};
inline constexpr EventCode kDrivesGood{43};
inline constexpr EventCode kDriveRefused{44};
inline constexpr EventCode kEstopDiscrepancy{46};
inline constexpr EventCode kOverrun{50};
inline constexpr EventCode kInternalFault{51};
inline constexpr EventCode kArchiveFailed{60};
inline constexpr EventCode kTargetChosen{70};
inline constexpr EventCode kGoalSet{71};
inline constexpr EventCode kMissionChanged{72};
inline constexpr EventCode kMissionTimedOut{73};

// A code with its words. {0}, {1}, {2} stand for the args; {0:state} for the word that a number of
// that kind means.
struct EventWords {
  EventCode code;
  Severity severity;
  const char* name;
  const char* text;
};

std::span<const EventWords> event_table();
const EventWords* words_of(EventCode code);  // null: no such code

// An event of this code with its severity. RT safe.
Event make_event(EventCode code, TimePoint time, double a = 0, double b = 0, double c = 0);

// kind as in {0:kind}, value the arg. "" for a kind that is not known: the number is shown.
using WordOf = std::function<std::string(std::string_view kind, int value)>;
std::string text_of(const Event& event, const WordOf& word_of);

}  // namespace gannet::telemetry

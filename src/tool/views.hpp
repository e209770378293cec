// The daemon's answers as text for people. A member that is absent or null shows as "–", so that a
// newer or older daemon is still readable. Any thread.
#pragma once

#include <string>

#include "src/control/json.hpp"

namespace gannet::tool {

std::string status_text(const control::Json& status);
std::string state_text(const control::Json& answer);     // of arm, disarm, reset, stop, manual
std::string visits_text(const control::Json& list);      // of mission list
std::string mission_text(const control::Json& mission);  // one line
std::string top_text(const control::Json& top);
std::string event_text(const control::Json& event);  // one line

}  // namespace gannet::tool

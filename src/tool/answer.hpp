// What `gannet locate` says of a target: as JSON for programs, as a few lines for people.
// Normal thread.
#pragma once

#include <optional>
#include <string>

#include "src/control/json.hpp"
#include "src/track/recognition.hpp"

namespace gannet::tool {

struct Answer {
  track::Recognition recognition;
  double time_ms = 0;                // decoded images → pose
  std::optional<std::string> model;  // none: a rectangle
};

// Metres, radians; pose fields are null when not found.
control::Json json_of(const Answer& answer);
control::Json json_of_error(const std::string& text);

// Millimetres and degrees.
std::string text_of(const Answer& answer);

}  // namespace gannet::tool

// The DroneCAN data types that Gannet speaks, as a page for people who decode a log: names, ids,
// signatures and the bits of each, listed by the codec's own descriptions. Start-up only.
#pragma once

#include <string>

namespace gannet::hal::dronecan {

std::string reference_text();  // Markdown

}  // namespace gannet::hal::dronecan

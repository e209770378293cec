// Json: the messages of the control socket, members in the order they were written.
// Control thread and tools; never on a real-time thread.
#pragma once

#include <nlohmann/json.hpp>

namespace gannet::control {

using Json = nlohmann::ordered_json;

}  // namespace gannet::control

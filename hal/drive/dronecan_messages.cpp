#include "hal/drive/dronecan_messages.hpp"

namespace gannet::hal::dronecan {

void NodeInfo::set_name(std::string_view text) {
  name.clear();
  for (char c : text.substr(0, 80)) name.push_back(static_cast<std::uint8_t>(c));
}

}  // namespace gannet::hal::dronecan

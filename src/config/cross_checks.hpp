// What each group allows by itself but not together with another. Start-up only.
#pragma once

#include <string>

#include "src/config/daemon_config.hpp"
#include "src/config/problems.hpp"

namespace gannet::config {

// Loads the rig into loaded, and adds what does not fit. file stands for values that nobody set.
void check_together(LoadedConfig& loaded, const std::string& file, Problems& problems);

}  // namespace gannet::config

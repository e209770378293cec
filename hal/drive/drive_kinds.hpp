// The table of drive kinds. A new protocol is one file pair and one line in drive_kinds.cpp.
// Start-up only.
#pragma once

#include <memory>
#include <vector>

#include "hal/drive/drive.hpp"
#include "hal/drive/drive_config.hpp"
#include "platform/base/result.hpp"

namespace gannet::hal {

// The caller owns the group.
Result<std::unique_ptr<DriveGroup>> make_drive_group(const DriveConfig& config);

// The frames that the group will want to receive, for make_can_bus. Empty: unknown kind.
std::vector<CanFilter> wanted_frames(const DriveConfig& config);

}  // namespace gannet::hal

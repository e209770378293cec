#include "hal/drive/drive_kinds.hpp"

#include "hal/drive/cia402_drive.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"

namespace gannet::hal {
namespace {

using Made = Result<std::unique_ptr<DriveGroup>>;

Made make_dronecan_esc(const DriveConfig& config) {
  auto drive = DroneCanEscDrive::create(config);
  if (!drive) return drive.error();
  return Made(std::move(*drive));
}

Made make_cia402(const DriveConfig& config) {
  auto drive = Cia402Drive::create(config);
  if (!drive) return drive.error();
  return Made(std::move(*drive));
}

struct Kind {
  const char* name;
  Made (*make)(const DriveConfig&);
  std::vector<CanFilter> (*wanted)(const DriveConfig&);
};
constexpr Kind kKinds[] = {
    {"dronecan_esc", make_dronecan_esc, DroneCanEscDrive::wanted_frames},
    {"cia402", make_cia402, Cia402Drive::wanted_frames},
};

}  // namespace

Made make_drive_group(const DriveConfig& config) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (config.kind == kind.name) return kind.make(config);
    known += std::string(known.empty() ? "" : ", ") + kind.name;
  }
  return Error{"drive.kind '" + config.kind + "' is unknown; there are " + known};
}

std::vector<CanFilter> wanted_frames(const DriveConfig& config) {
  for (const Kind& kind : kKinds) {
    if (config.kind == kind.name) return kind.wanted(config);
  }
  return {};
}

}  // namespace gannet::hal

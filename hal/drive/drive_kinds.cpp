#include "hal/drive/drive_kinds.hpp"

#include "hal/drive/cia402_drive.hpp"
#include "hal/drive/dronecan_esc_drive.hpp"
#include "hal/drive/odrive_drive.hpp"
#include "hal/drive/vesc_drive.hpp"

namespace gannet::hal {
namespace {

using Made = Result<std::unique_ptr<DriveGroup>>;

template <class Drive>
Made make(const DriveConfig& config) {
  auto drive = Drive::create(config);
  if (!drive) return drive.error();
  return Made(std::move(*drive));
}

struct Kind {
  const char* name;
  Made (*create)(const DriveConfig&);
  std::vector<CanFilter> (*wanted)(const DriveConfig&);
};
constexpr Kind kKinds[] = {
    {"dronecan_esc", make<DroneCanEscDrive>, DroneCanEscDrive::wanted_frames},
    {"cia402", make<Cia402Drive>, Cia402Drive::wanted_frames},
    {"vesc", make<VescDrive>, VescDrive::wanted_frames},
    {"odrive", make<OdriveDrive>, OdriveDrive::wanted_frames},
};

}  // namespace

Made make_drive_group(const DriveConfig& config) {
  std::string known;
  for (const Kind& kind : kKinds) {
    if (config.kind == kind.name) return kind.create(config);
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

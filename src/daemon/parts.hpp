// Parts: what the config asks for, made. First the pure parts, which need no device and are all
// that --check makes; then the devices. Start-up only.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/camera/stereo_camera.hpp"
#include "hal/can/can_bus.hpp"
#include "hal/drive/drive.hpp"
#include "hal/gpio/digital_line.hpp"
#include "platform/base/result.hpp"
#include "src/config/daemon_config.hpp"
#include "src/servo/servo_law.hpp"
#include "src/track/target_tracker.hpp"
#include "src/vehicle/vehicle.hpp"

namespace gannet::daemon {

struct Parts {
  std::vector<std::string> model_names;
  std::vector<vision::Symmetry> model_symmetries;  // by index, as the names
  std::unique_ptr<track::TargetTracker> tracker;
  std::unique_ptr<vehicle::Vehicle> vehicle;
  std::unique_ptr<servo::ServoLaw> law;
  std::unique_ptr<hal::DriveGroup> drives;  // null without a vehicle
};

// Error: of the config or of a file that it names.
Result<Parts> make_parts(const config::LoadedConfig& loaded);

// For --check: a recording that is to be replayed is there, has pairs, and its images fit the rig.
// Error: with the line that names it.
Result<void> check_recording(const config::LoadedConfig& loaded);

struct Devices {
  std::unique_ptr<hal::StereoCamera> camera;  // started
  std::unique_ptr<hal::CanBus> bus;           // null without a vehicle
  std::unique_ptr<hal::DigitalInput> estop;
  std::unique_ptr<hal::DigitalInput> estop_second;  // null: the e-stop has one channel
  std::unique_ptr<hal::DigitalOutput> light;
  std::unique_ptr<hal::DigitalOutput> release;  // inactive
  std::unique_ptr<hal::DigitalOutput> lights;   // active, until destruction
  std::unique_ptr<hal::DigitalOutput> strobe;   // active, until destruction
};

// drives: of parts; null without a vehicle. Error: which device, and what is wrong with it.
Result<Devices> open_devices(const config::LoadedConfig& loaded, const hal::DriveGroup* drives,
                             TimePoint now);

}  // namespace gannet::daemon

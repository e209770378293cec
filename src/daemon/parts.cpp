#include "src/daemon/parts.hpp"

#include <algorithm>
#include <utility>

#include "hal/camera/camera_kinds.hpp"
#include "hal/can/can_kinds.hpp"
#include "hal/drive/drive_kinds.hpp"
#include "hal/gpio/line_kinds.hpp"
#include "platform/base/nearest_word.hpp"
#include "src/image_file/image_file.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/track/track_config.hpp"

namespace gannet::daemon {
namespace {

// "gannet.toml:4: models: …", where a file or --set said it.
Error at_origin(const config::LoadedConfig& loaded, const std::string& key,
                const std::string& text) {
  const auto found = loaded.origins.find(key);
  const std::string where = found == loaded.origins.end() ? "" : found->second.text() + ": ";
  return Error{where + key + ": " + text};
}

Result<std::vector<vision::PatchModel>> load_models(const config::LoadedConfig& loaded,
                                                    std::vector<std::string>& names) {
  const config::DaemonConfig& config = loaded.config;
  const auto refuse = [&](const std::string& text) { return at_origin(loaded, "models", text); };
  std::vector<vision::PatchModel> models;
  for (const std::string& path : config.models) {
    auto photo = modeldb::load_model(path);
    if (!photo) return refuse(photo.error().text);
    auto model = vision::make_patch_model(*photo, {.inside_points = config.track.model_points});
    if (!model) return refuse(path + ": " + model.error().text);
    if (std::find(names.begin(), names.end(), model->name) != names.end()) {
      return refuse(path + ": the name \"" + model->name + "\" is there twice");
    }
    names.push_back(model->name);
    models.push_back(std::move(*model));
  }
  return models;
}

Error at_key(const std::string& key, const Error& error) { return Error{key + ": " + error.text}; }

Result<void> check_size(const hal::StereoCamera& camera, const Intrinsics& rig) {
  if (camera.width() == rig.width && camera.height() == rig.height) return {};
  return Error{"its images have " + std::to_string(camera.width()) + " × " +
               std::to_string(camera.height()) + " pixels, the rig says " +
               std::to_string(rig.width) + " × " + std::to_string(rig.height)};
}

// on: what the output is from now on.
Result<void> open_output(const char* key, const hal::LineConfig& config, bool on, TimePoint now,
                         std::unique_ptr<hal::DigitalOutput>& line) {
  auto made = hal::make_output(config);
  if (!made) return at_key(key, made.error());
  line = std::move(*made);
  line->write(on, now);
  return {};
}

Result<void> open_lines(const config::GpioConfig& config, Devices& devices, TimePoint now) {
  auto estop = hal::make_input(config.estop);
  if (!estop) return at_key("gpio.estop", estop.error());
  devices.estop = std::move(*estop);
  if (config.estop_second.kind != "none") {
    auto second = hal::make_input(config.estop_second);
    if (!second) return at_key("gpio.estop_second", second.error());
    devices.estop_second = std::move(*second);
  }
  auto opened = open_output("gpio.release", config.release, false, now, devices.release);
  if (opened) opened = open_output("gpio.light", config.light, false, now, devices.light);
  if (opened) opened = open_output("gpio.lights", config.lights, true, now, devices.lights);
  if (opened) opened = open_output("gpio.strobe", config.strobe, true, now, devices.strobe);
  return opened;
}

Result<void> check_visits(const config::LoadedConfig& loaded,
                          const std::vector<std::string>& models) {
  const std::vector<servo::VisitConfig>& visits = loaded.config.mission.visits;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const std::string& model = visits[i].model;
    if (std::find(models.begin(), models.end(), model) != models.end()) continue;
    const std::string_view near = nearest_word(model, models);
    return at_origin(loaded, "mission.visit[" + std::to_string(i) + "].model",
                     "there is no model \"" + model + "\" in the config's models" +
                         (near.empty() ? "" : "; did you mean \"" + std::string(near) + "\"?"));
  }
  return {};
}

}  // namespace

Result<Parts> make_parts(const config::LoadedConfig& loaded) {
  const config::DaemonConfig& config = loaded.config;
  Parts parts;
  auto models = load_models(loaded, parts.model_names);
  if (!models) return models.error();
  if (auto checked = check_visits(loaded, parts.model_names); !checked) return checked.error();
  for (const vision::PatchModel& model : *models) parts.model_symmetries.push_back(model.symmetry);
  auto tracker = track::TargetTracker::create(config.track, loaded.rig, std::move(*models));
  if (!tracker) return at_key("track", tracker.error());
  parts.tracker = std::move(*tracker);
  vehicle::VehicleConfig vehicle_config = config.vehicle;
  for (const hal::MotorConfig& motor : config.drive.motors)
    vehicle_config.arm.full_speed_rad_s.push_back(motor.full_speed_rad_s * motor.max_command);
  vehicle_config.agv.full_speed_rad_s = vehicle_config.arm.full_speed_rad_s;
  auto vehicle = vehicle::create_vehicle(vehicle_config);
  if (!vehicle) return at_key("vehicle", vehicle.error());
  parts.vehicle = std::move(*vehicle);
  const bool has_vehicle = parts.vehicle->motors() > 0;
  // A law needs to know where the cameras sit; without a vehicle nothing asks for it.
  StereoRig rig = loaded.rig;
  if (!has_vehicle && !rig.body_from_hand) rig.body_from_hand = Transform<Body, Hand>{};
  auto law = servo::create_servo_law(config.servo, rig);
  if (!law) return at_key("servo", law.error());
  parts.law = std::move(*law);
  if (!has_vehicle) return parts;
  hal::DriveConfig drive = config.drive;
  drive.cia402.servo_period_s = 1 / config.realtime.servo_rate_hz;
  auto drives = hal::make_drive_group(drive);
  if (!drives) return at_key("drive", drives.error());
  parts.drives = std::move(*drives);
  if (parts.drives->size() != parts.vehicle->motors()) {
    return Error{"drive.motor: " + std::to_string(parts.drives->size()) + " motors for " +
                 std::to_string(parts.vehicle->motors()) + " of the vehicle"};
  }
  return parts;
}

Result<void> check_recording(const config::LoadedConfig& loaded) {
  if (loaded.config.camera.kind != "replay") return {};
  const char* const key = "camera.replay.directory";
  auto camera =
      hal::make_stereo_camera(loaded.config.camera, &image_file::decode_image, hal::Pace::kStepped);
  if (!camera) return at_origin(loaded, key, camera.error().text);
  if (auto fits = check_size(**camera, loaded.rig.left); !fits)
    return at_origin(loaded, key, fits.error().text);
  return {};
}

Result<Devices> open_devices(const config::LoadedConfig& loaded, const hal::DriveGroup* drives,
                             TimePoint now) {
  const config::DaemonConfig& config = loaded.config;
  Devices devices;
  if (auto opened = open_lines(config.gpio, devices, now); !opened) return opened.error();
  if (drives != nullptr) {
    auto bus =
        hal::make_can_bus(config.can, hal::wanted_frames(config.drive), drives->max_frames(), now);
    if (!bus) return at_key("can", bus.error());
    devices.bus = std::move(*bus);
  }
  const auto pace = config.clock.kind == "stepped" ? hal::Pace::kStepped : hal::Pace::kLive;
  auto camera = hal::make_stereo_camera(config.camera, &image_file::decode_image, pace);
  if (!camera) return at_key("camera", camera.error());
  devices.camera = std::move(*camera);
  if (auto started = devices.camera->start(); !started) return at_key("camera", started.error());
  if (auto fits = check_size(*devices.camera, loaded.rig.left); !fits)
    return at_key("camera", fits.error());
  return devices;
}

}  // namespace gannet::daemon

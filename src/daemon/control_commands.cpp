#include "src/daemon/control_commands.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "platform/base/nearest_word.hpp"
#include "src/telemetry/event_codes.hpp"

namespace gannet::daemon {

using control::Answer;
using control::ErrorCode;
using control::Failure;
using control::Json;
using safety::Cause;
using safety::Request;

namespace {

Failure bad_params(const std::string& text) { return {ErrorCode::kBadParams, text}; }

// n finite numbers of magnitude up to limit.
std::optional<std::vector<double>> numbers(const Json& params, const char* key, std::size_t n,
                                           double limit) {
  if (!params.contains(key) || !params[key].is_array() || params[key].size() != n) return {};
  std::vector<double> values;
  for (const Json& element : params[key]) {
    if (!element.is_number()) return {};
    values.push_back(element.get<double>());
    if (!(std::abs(values.back()) <= limit)) return {};  // also refuses what is no number
  }
  return values;
}

// What a person can do about it.
const char* advice(Cause cause) {
  switch (cause) {
    case Cause::kEstop:
      return "the emergency stop is pressed";
    case Cause::kEstopUnknown:
      return "the emergency stop line cannot be read, or its two contacts disagreed: then press "
             "and release it once";
    case Cause::kInternalFault:
      return "an internal fault: restart the daemon and report it";
    case Cause::kDriveFault:
      return "a drive reports a fault";
    case Cause::kDrivesSilent:
      return "a drive is not heard: is it powered and on the bus?";
    case Cause::kDrivesNotReady:
      return "a drive is not set up: see gannet events";
    case Cause::kDrivesUnguarded:
      return "a drive would not stop by itself if the daemon died: see gannet status, and "
             "accept_unguarded";
    case Cause::kBusDown:
      return "the CAN bus is down";
    case Cause::kOverruns:
      return "the servo loop misses its periods";
    case Cause::kLimits:
      return "a motor is hotter than safety.motor_temperature_c or draws more than "
             "safety.motor_current_a: let it cool, free its propeller";
    case Cause::kNoEstop:
      return "there is no emergency stop: configure gpio.estop, or set safety.accept_no_estop = "
             "true";
    case Cause::kNotStarted:
      return "the daemon is still starting";
    case Cause::kNotReset:
      return "stopped or faulted: reset first";
    case Cause::kNoVehicle:
      return "vehicle.kind is \"none\"";
    case Cause::kNoCamera:
      return "the cameras are silent";
    default:
      return "not in this state";
  }
}

Failure refused(const std::string& method, Cause cause) {
  return {ErrorCode::kRefused, method + " is refused: " + advice(cause), safety::to_string(cause)};
}

// Rolls at which a model looks like itself, degrees; "any"; empty: none.
Json alike_json(const std::vector<vision::Symmetry>& symmetries, int model) {
  constexpr double kDegrees = 180 / 3.14159265358979323846;
  Json alike = Json::array();
  if (model < 0 || static_cast<std::size_t>(model) >= symmetries.size()) return alike;
  const vision::Symmetry& symmetry = symmetries[static_cast<std::size_t>(model)];
  if (symmetry.any_roll) return "any";
  for (const double roll : symmetry.rolls) alike.push_back(std::round(kDegrees * roll));
  return alike;
}

Json target_choice_json(const TargetChoice& target, const std::vector<std::string>& models) {
  Json json;
  json["id"] = target.id;
  switch (target.kind) {
    case TargetChoice::Kind::kNone:
      json["kind"] = "none";
      break;
    case TargetChoice::Kind::kModel:
      json["kind"] = "model";
      json["model"] = models[static_cast<std::size_t>(target.model)];
      break;
    case TargetChoice::Kind::kRectangle:
      json["kind"] = "roi";
      json["roi"] = {target.rectangle.x, target.rectangle.y, target.rectangle.width,
                     target.rectangle.height};
      break;
  }
  return json;
}

}  // namespace

const std::vector<ControlCommands::Entry>& ControlCommands::table() {
  static const std::vector<Entry> kTable = {
      {"status", &ControlCommands::status, {}},
      {"top", &ControlCommands::top, {}},
      {"events", &ControlCommands::events, {"since", "max"}},
      {"config_show", &ControlCommands::config_show, {}},
      {"arm", &ControlCommands::arm, {}},
      {"disarm", &ControlCommands::disarm, {}},
      {"reset", &ControlCommands::reset, {}},
      {"stop", &ControlCommands::stop, {}},
      {"target", &ControlCommands::target, {"model", "roi", "none"}},
      {"goal", &ControlCommands::goal, {"mm"}},
      {"mission", &ControlCommands::mission, {"do"}},
      {"manual", &ControlCommands::manual, {"linear_m_s", "angular_rad_s"}},
  };
  return kTable;
}

std::vector<std::string> ControlCommands::methods() {
  std::vector<std::string> names;
  for (const Entry& entry : table()) names.emplace_back(entry.name);
  return names;
}

ControlCommands::ControlCommands(Setting setting, Reports* reports, CommandLines* lines)
    : setting_(std::move(setting)),
      reports_(reports),
      lines_(lines),
      params_(setting_.loaded->config.servo.params),
      mission_(setting_.loaded->config.mission, setting_.models) {}

Answer ControlCommands::handle(const control::Request& request) {
  reports_->refresh();
  for (const Entry& entry : table()) {
    if (request.method != entry.name) continue;
    for (const auto& [key, value] : request.params.items()) {
      const auto& known = entry.params;
      if (std::find(known.begin(), known.end(), key) != known.end()) continue;
      const std::string_view near = nearest_word(key, known);
      return bad_params(request.method + " has no param \"" + key + "\"" +
                        (near.empty() ? "" : "; did you mean \"" + std::string(near) + "\"?"));
    }
    return (this->*entry.method)(request.params);
  }
  const std::string near(nearest_word(request.method, methods()));
  return Failure{ErrorCode::kUnknownMethod,
                 "there is no method \"" + request.method + "\"" +
                     (near.empty() ? "" : "; did you mean \"" + near + "\"?")};
}

Json ControlCommands::state_json() const {
  const ServoReport& servo = reports_->servo();
  Json json;
  json["state"] = safety::to_string(servo.supervisor.state);
  json["cause"] = safety::to_string(servo.outputs.cause);
  json["permit"] = safety::to_string(servo.outputs.permit);
  json["by_hand"] = servo.outputs.by_hand;
  json["estop"] = !servo.has_estop                         ? "no line"
                  : servo.estop == safety::Line::kInactive ? "inactive"
                  : servo.estop == safety::Line::kActive   ? "active"
                                                           : "unknown";
  json["estop_presses"] = servo.estop_presses;
  json["obstacle"] = safety::to_string(servo.outputs.obstacle);
  json["light"] = safety::to_string(servo.outputs.light);
  return json;
}

Json ControlCommands::drives_json() const {
  const ServoReport& servo = reports_->servo();
  Json json;
  json["bus"] = to_string(servo.bus);
  json["bus_errors"]["transmit"] = servo.can.transmit_errors;
  json["bus_errors"]["receive"] = servo.can.receive_errors;
  json["all_alive"] = servo.drives.all_alive;
  json["any_fault"] = servo.drives.any_fault;
  json["all_ready"] = servo.drives.all_ready;
  json["guards_itself"] = servo.drives.guards_itself;
  json["first_bad"] = servo.drives.first_bad;
  json["trouble"] = servo.drives.trouble;
  json["trouble_code"] = servo.drives.trouble_code;
  json["reach_scale"] = servo.reach_scale;
  return json;
}

Answer ControlCommands::status(const Json&) {
  const config::DaemonConfig& config = setting_.loaded->config;
  const TimePoint now = setting_.now();
  Json json = state_json();
  json["version"] = GANNET_VERSION;
  json["time_ns"] = to_ns(now);
  json["clock"] = config.clock.kind;
  json["vehicle"] = config.vehicle.kind;
  json["camera"] = config.camera.kind;
  json["models"] = setting_.models;
  json["chosen"] = target_choice_json(target_, setting_.models);
  if (target_.kind == TargetChoice::Kind::kModel)
    json["chosen"]["alike_deg"] = alike_json(setting_.symmetries, target_.model);
  json["mission"] = mission_.status_json();
  json["goal_mm"] = {params_.goal_x_m * 1e3, params_.goal_y_m * 1e3, params_.goal_z_m * 1e3};
  json["estimate"] = reports_->estimate_json(setting_.models, now);
  json["target"] = reports_->target_json(setting_.loaded->rig);
  if (config.vehicle.kind != "none") json["drives"] = drives_json();
  if (setting_.server != nullptr) {
    json["control"]["requests"] = setting_.server->requests;
    json["control"]["junk"] = setting_.server->junk;
    json["control"]["dropped"] = setting_.server->dropped;
  }
  return json;
}

Answer ControlCommands::top(const Json&) {
  const TimePoint now = setting_.now();
  const auto age = [now](TimePoint t) {
    return t == TimePoint{} ? Json() : Json(to_seconds(now - t) * 1e3);
  };
  Json json = state_json();
  json["track"] = gannet::to_string(reports_->vision().estimate.state);
  json["fitness"] = reports_->vision().estimate.fitness;
  json["loops"] = reports_->loops_json();
  json["latencies"] = reports_->histograms_json();
  json["drops"] = reports_->drops_json();
  json["cameras"] = reports_->cameras_json();
  json["ages_ms"]["capture"] = age(reports_->capture().loop.time);
  json["ages_ms"]["vision"] = age(reports_->vision().loop.time);
  json["ages_ms"]["servo"] = age(reports_->servo().loop.time);
  json["ages_ms"]["estimate"] = age(reports_->vision().estimate.capture_time);
  return json;
}

Answer ControlCommands::events(const Json& params) {
  for (const auto& [key, value] : params.items()) {
    if (!value.is_number_integer() || value < 0)
      return bad_params("\"" + key + "\" must be a whole number");
  }
  return reports_->events_json(params.value("since", std::uint64_t{0}),
                               params.value("max", std::size_t{1000}));
}

Answer ControlCommands::config_show(const Json&) {
  Json json;
  json["values"] = Json::array();
  const std::string text = setting_.loaded->show();
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = line.find(" = ");
    const std::size_t hash = line.rfind("  # ");
    if (equals == std::string::npos || hash == std::string::npos) continue;
    json["values"].push_back({{"key", line.substr(0, equals)},
                              {"value", line.substr(equals + 3, hash - equals - 3)},
                              {"origin", line.substr(hash + 4)}});
  }
  json["text"] = text;
  return json;
}

Answer ControlCommands::arm(const Json&) {
  const safety::Outputs& outputs = reports_->servo().outputs;
  if (reports_->servo().loop.cycles == 0) return refused("arm", Cause::kNotStarted);
  if (outputs.obstacle != Cause::kNone) return refused("arm", outputs.obstacle);
  return request(Request::kArm, "arm");
}
Answer ControlCommands::disarm(const Json&) { return request(Request::kDisarm, "disarm"); }
Answer ControlCommands::reset(const Json&) { return request(Request::kReset, "reset"); }
Answer ControlCommands::stop(const Json&) { return request(Request::kStop, "stop"); }

Answer ControlCommands::request(Request what, const char* name) {
  ServoCommand command;
  command.request = what;
  if (!push(command)) return Failure{ErrorCode::kBusy, "too many requests wait for the servo loop"};
  const bool served = wait_until_served();
  const Cause cause = reports_->servo().refused;
  if (served && cause != Cause::kNone) return refused(name, cause);
  Json json = state_json();
  json["served"] = served;  // false in stepped time: at the next step
  return json;
}

bool ControlCommands::push(ServoCommand command) {
  command.number = ++command_count_;
  return lines_->to_servo.push(command);
}

// A servo cycle takes at most 100 ms; a loop that hangs is not waited for.
bool ControlCommands::wait_until_served() {
  if (!setting_.pause) return false;
  for (int i = 0; i < 200; ++i) {
    reports_->refresh();
    if (reports_->servo().served >= command_count_) return true;
    setting_.pause();
  }
  return false;
}

Answer ControlCommands::target(const Json& params) {
  if (params.size() != 1) return bad_params("target takes one of \"model\", \"roi\", \"none\"");
  TargetChoice choice;
  if (params.contains("model")) {
    if (!params["model"].is_string()) return bad_params("\"model\" must be a name");
    const std::string name = params["model"].get<std::string>();
    const auto found = std::find(setting_.models.begin(), setting_.models.end(), name);
    if (found == setting_.models.end()) {
      const std::string near(nearest_word(name, setting_.models));
      return bad_params("there is no model \"" + name + "\" in the config's models" +
                        (near.empty() ? "" : "; did you mean \"" + near + "\"?"));
    }
    choice.kind = TargetChoice::Kind::kModel;
    choice.model = static_cast<int>(found - setting_.models.begin());
  } else if (params.contains("roi")) {
    const auto roi = numbers(params, "roi", 4, 1e6);
    if (!roi) return bad_params("\"roi\" must be four whole numbers X, Y, W, H");
    for (const double v : *roi) {
      if (v != std::floor(v)) return bad_params("\"roi\" must be whole pixels");
    }
    vision::Rectangle& r = choice.rectangle;
    r = {static_cast<int>((*roi)[0]), static_cast<int>((*roi)[1]), static_cast<int>((*roi)[2]),
         static_cast<int>((*roi)[3])};
    constexpr int kLeast = 8;  // pixels; as the tracker has it
    if (r.x < 0 || r.y < 0 || r.width < kLeast || r.height < kLeast ||
        r.x + r.width > setting_.image_width || r.y + r.height > setting_.image_height) {
      return bad_params("the rectangle must be 8 × 8 pixels at least and inside the image of " +
                        std::to_string(setting_.image_width) + " × " +
                        std::to_string(setting_.image_height) + " pixels");
    }
    choice.kind = TargetChoice::Kind::kRectangle;
  } else if (params["none"] != true) {
    return bad_params("\"none\" must be true");
  }
  if (!choose(choice))
    return Failure{ErrorCode::kBusy, "too many choices wait for the vision loop"};
  obey(mission_.stop(true));
  return target_choice_json(target_, setting_.models);
}

bool ControlCommands::choose(TargetChoice choice) {
  if (choice.kind != TargetChoice::Kind::kNone) choice.id = target_count_ + 1;
  if (!lines_->to_vision.push(choice)) return false;
  if (choice.kind != TargetChoice::Kind::kNone) ++target_count_;
  target_ = choice;
  owes_none_ = false;
  return true;
}

Answer ControlCommands::goal(const Json& params) {
  constexpr double kFarthestMm = 100'000;
  const auto mm = numbers(params, "mm", 3, kFarthestMm);
  if (!mm) return bad_params("\"mm\" must be three numbers [x, y, z] within ±100000");
  if ((*mm)[2] <= 0) return bad_params("z must be positive: the target is before the cameras");
  obey(mission_.stop(true));
  set_goal(Eigen::Vector3d(mm->data()) * 1e-3);
  return Json{{"goal_mm", *mm}};
}

void ControlCommands::set_goal(const Eigen::Vector3d& goal_m) {
  params_.goal_x_m = goal_m.x();
  params_.goal_y_m = goal_m.y();
  params_.goal_z_m = goal_m.z();
  lines_->params.write(params_);
  reports_->add_event(telemetry::make_event(telemetry::kGoalSet, setting_.now(), goal_m.x() * 1e3,
                                            goal_m.y() * 1e3, goal_m.z() * 1e3));
}

Answer ControlCommands::manual(const Json& params) {
  constexpr double kFastest = 5;  // m/s, rad/s
  if (setting_.loaded->config.vehicle.kind == "none") return refused("manual", Cause::kNoVehicle);
  const auto linear = numbers(params, "linear_m_s", 3, kFastest);
  const auto angular = numbers(params, "angular_rad_s", 3, kFastest);
  if (!linear || !angular) {
    return bad_params(
        "manual takes \"linear_m_s\" and \"angular_rad_s\", three numbers each, body axes x "
        "forward, y left, z up, within ±5");
  }
  ServoCommand command;
  command.by_hand = true;
  command.time = setting_.now();
  command.velocity = {{(*linear)[0], (*linear)[1], (*linear)[2]},
                      {(*angular)[0], (*angular)[1], (*angular)[2]}};
  if (!push(command)) return Failure{ErrorCode::kBusy, "too many commands wait"};
  Json json = state_json();
  json["timeout_s"] = setting_.loaded->config.safety.manual_age_s;
  return json;
}

}  // namespace gannet::daemon

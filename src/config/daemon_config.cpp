#include "src/config/daemon_config.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "src/config/cross_checks.hpp"
#include "src/config/printer.hpp"
#include "src/config/rig_file.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {

namespace fs = std::filesystem;

void describe(Visitor& v, BoardConfig& c) {
  v.field("name", c.name,
          {.help = "Board file that states the facts below and the cores that suit it: a name "
                   "such as raspberry-pi-5, or a path with a slash."});
  v.field("cores", c.cores, {.min = 0, .max = 1024, .help = "Processor cores; 0: not known."});
  v.field("cameras", c.cameras, {.help = "Device files of the board's camera connectors."});
  v.field("can_interfaces", c.can_interfaces, {.help = "Names of its CAN interfaces."});
  v.field("gpio_chips", c.gpio_chips, {.help = "GPIO chips whose lines reach its connectors."});
}

void describe(Visitor& v, RealtimeConfig& c) {
  v.field("servo_rate_hz", c.servo_rate_hz,
          {.min = 10, .max = 2000, .unit = "Hz", .help = "Cycles of the servo loop."});
  v.field("lock_memory", c.lock_memory,
          {.help = "Lock all memory, so that no loop ever waits for a page."});
  v.field("worker_cores", c.worker_cores,
          {.min = -1,
           .max = 1023,
           .help = "A helper of the vision thread on each of these cores; -1: on any."});
  v.field("worker_priority", c.worker_priority,
          {.min = 0, .max = 99, .help = "FIFO priority of the helpers; 0: normal scheduling."});
  v.group("capture", c.capture, "The thread that takes frames from the cameras.");
  v.group("vision", c.vision, "The thread that recognises.");
  v.group("servo", c.servo, "The thread that steers.");
}

void describe(Visitor& v, ClockConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"live", "stepped"},
           .help = "live: the machine's clock; stepped: gannet-world says when time goes on, for "
                   "runs that repeat bit for bit."});
  v.field("step_socket", c.step_socket, {.help = "Socket of the stepped clock."});
}

void describe(Visitor& v, GpioConfig& c) {
  v.group("estop", c.estop, "Input: emergency stop, active when pressed.");
  v.group("estop_second", c.estop_second,
          "Input: the button's other contact, wired to move the other way; active when pressed.");
  v.group("release", c.release,
          "Output: release of the spear or gripper; inactive but for a catch.");
  v.group("light", c.light, "Output: off, slow, on or fast says the state to people near by.");
  v.group("lights", c.lights, "Output: the cameras' lights, active while the daemon runs.");
  v.group("strobe", c.strobe, "Output: lets a strobe flash, active while the daemon runs.");
}

void describe(Visitor& v, FramesConfig& c) {
  v.field("kind", c.kind,
          {.choices = {"none", "directory"},
           .help = "Where frames go after recognition: nowhere, or into a directory."});
  v.field("directory", c.directory, {.help = "The directory; it is created."});
}

void describe(Visitor& v, ControlConfig& c) {
  v.field("socket", c.socket,
          {.help = "Unix socket on which gannet talks to the daemon; empty: none."});
  v.field("group", c.group,
          {.help = "Group whose members may connect; empty: only the daemon's own user."});
}

void describe(Visitor& v, DaemonConfig& c) {
  v.field("rig", c.rig, {.help = "Calibration of the two cameras: path of a RIG file."});
  v.field("models", c.models,
          {.help = "Targets that can be chosen by name: paths of .gannet files."});
  v.group("board", c.board, "Facts of the computer.");
  v.group("realtime", c.realtime, "Threads, their cores and rates.");
  v.group("clock", c.clock, "What time is.");
  v.group("camera", c.camera, "Where image pairs come from.");
  v.group("can", c.can, "The bus to the motors.");
  v.group("drive", c.drive, "The motors' protocol and places on the bus.");
  v.group("gpio", c.gpio, "Digital lines.");
  v.group("track", c.track, "Recognition and the state of a track.");
  v.group("filter", c.filter, "The filter that predicts the pose to now.");
  v.group("servo", c.servo, "From pose to motion.");
  v.group("mission", c.mission, "Targets that are visited in turn.");
  v.group("vehicle", c.vehicle, "The vehicle that is steered; none: poses only.");
  v.group("safety", c.safety, "Limits of the supervisor.");
  v.group("frames", c.frames, "What becomes of frames after recognition.");
  v.group("control", c.control, "How people and programs talk to the daemon.");
}

namespace {

struct Layer {
  std::string source;  // as problems and origins name it
  TomlValue tree;
};

void forget_lines(TomlValue& value) {
  value.line = 0;
  for (TomlValue& member : value.members) forget_lines(member);
  for (TomlValue& element : value.elements) forget_lines(element);
}

// "room.key=value" is a line of TOML; a bare word stands for a string.
std::optional<Layer> layer_of_set(const std::string& set, Problems& problems) {
  const std::string source = "--set " + set;
  const std::size_t equals = set.find('=');
  const bool has_form = equals != std::string::npos && equals > 0 && equals + 1 < set.size() &&
                        set.find('\n') == std::string::npos;
  if (has_form) {
    const std::string key = set.substr(0, equals);
    const std::string value = set.substr(equals + 1);
    Result<TomlValue> tree = parse_toml(key + " = " + value, source);
    if (!tree) tree = parse_toml(key + " = " + toml_string(value), source);
    if (tree) {
      forget_lines(*tree);
      return Layer{source, std::move(*tree)};
    }
  }
  problems.add({source, 0}, "is not of the form room.key=value");
  return std::nullopt;
}

// An unreadable file is one problem; its text says the place itself.
void add_file(const std::string& path, std::vector<Layer>& layers, std::string& unreadable) {
  Result<TomlValue> tree = read_toml(path);
  if (tree) {
    layers.push_back({path, std::move(*tree)});
  } else {
    unreadable += (unreadable.empty() ? "" : "\n") + tree.error().text;
  }
}

std::vector<std::string> drop_ins(const std::string& file) {
  std::vector<std::string> paths;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(file + ".d", error))
    if (entry.path().extension() == ".toml") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

const TomlValue* board_name(const std::vector<Layer>& layers, const Layer** said_by) {
  for (auto layer = layers.rbegin(); layer != layers.rend(); ++layer) {
    const TomlValue* board = layer->tree.find("board");
    const TomlValue* name = board == nullptr ? nullptr : board->find("name");
    if (name == nullptr || name->kind != TomlValue::Kind::kText || name->text.empty()) continue;
    *said_by = &*layer;
    return name;
  }
  return nullptr;
}

std::string beside(const std::string& file, const std::string& path) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(file).parent_path() / path).string();
}

std::string board_file(const TomlValue& name, const Layer& said_by,
                       const std::vector<std::string>& folders) {
  if (name.text.find('/') != std::string::npos)
    return name.line > 0 ? beside(said_by.source, name.text) : name.text;
  std::error_code error;
  for (const std::string& folder : folders) {
    const fs::path path = fs::path(folder) / (name.text + ".toml");
    if (fs::exists(path, error)) return path.string();
  }
  return "";
}

void add_board(const ConfigSources& sources, std::vector<Layer>& layers, Problems& problems,
               std::string& unreadable) {
  const Layer* said_by = nullptr;
  const TomlValue* name = board_name(layers, &said_by);
  if (name == nullptr) return;
  const std::vector<std::string> folders =
      sources.boards.empty() ? board_folders() : sources.boards;
  const std::string path = board_file(*name, *said_by, folders);
  if (path.empty()) {
    problems.add({said_by->source, name->line}, "board.name: there is no board file " +
                                                    toml_string(name->text) + " in " +
                                                    joined(folders, ", "));
    return;
  }
  std::vector<Layer> board;
  add_file(path, board, unreadable);
  layers.insert(layers.begin(), board.begin(), board.end());
}

// What a file says of paths is meant from where the file is.
void resolve(const Origins& origins, const std::string& key, std::string& path) {
  const auto origin = origins.find(key);
  if (origin != origins.end() && origin->second.line > 0)
    path = beside(origin->second.source, path);
}

void resolve_paths(LoadedConfig& loaded) {
  DaemonConfig& c = loaded.config;
  resolve(loaded.origins, "rig", c.rig);
  for (std::string& model : c.models) resolve(loaded.origins, "models", model);
  resolve(loaded.origins, "camera.replay.directory", c.camera.replay.directory);
  resolve(loaded.origins, "frames.directory", c.frames.directory);
}

}  // namespace

std::string LoadedConfig::show() const { return values_with_origins(config, origins); }

Result<LoadedConfig> load_daemon_config(const ConfigSources& sources) {
  LoadedConfig loaded;
  Problems problems;
  std::string unreadable;
  std::vector<Layer> layers;
  if (!sources.file.empty()) {
    add_file(sources.file, layers, unreadable);
    for (const std::string& path : drop_ins(sources.file)) add_file(path, layers, unreadable);
  }
  for (const std::string& set : sources.sets)
    if (std::optional<Layer> layer = layer_of_set(set, problems))
      layers.push_back(std::move(*layer));
  add_board(sources, layers, problems, unreadable);
  for (const Layer& layer : layers) {
    load(layer.tree, layer.source, loaded.config, loaded.origins, problems);
    if (layer.source.rfind("--set ", 0) != 0) loaded.files.push_back(layer.source);
  }
  if (unreadable.empty() && problems.empty()) {
    resolve_paths(loaded);
    check_together(loaded, sources.file, problems);
  }
  if (!problems.empty()) unreadable += (unreadable.empty() ? "" : "\n") + problems.error().text;
  if (!unreadable.empty()) return Error{unreadable};
  return loaded;
}

std::string print_default() {
  return "# gannetd's configuration, every key with its built-in value. See gannet.toml(5).\n" +
         commented_file(DaemonConfig{});
}

std::vector<std::string> board_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  // <prefix>/bin or <prefix>/sbin; build/<profile>/bin; build/<profile>/tests/unit/src/<room>.
  std::vector<std::string> folders = {(program / "../share/gannet/boards").lexically_normal()};
  for (fs::path at = program; at.has_relative_path(); at = at.parent_path())
    if (fs::exists(at / "platform/boards", error)) folders.push_back(at / "platform/boards");
  return folders;
}

std::string config_markdown() {
  return "# gannet.toml\n\nEvery key of gannetd's configuration. Made from the program's own "
         "description by `make docs`; do not edit.\n" +
         markdown_reference(DaemonConfig{});
}

std::string config_man_page() {
  return std::string(".\\\" Made from the program's own description; do not edit.\n") +
         ".TH gannet.toml 5 \"\" \"Gannet " + GANNET_VERSION + "\" \"Gannet\"\n" +
         ".SH NAME\ngannet.toml \\- configuration of gannetd\n.SH DESCRIPTION\n"
         "A TOML file. Values hold in this order, the last one wins: built-in, board file, "
         "gannet.toml, gannet.toml.d/*.toml by name, \\-\\-set room.key=value. Paths are relative "
         "to the file that says them. All problems are told at once; unknown keys are refused.\n"
         ".SH KEYS\n" +
         man_reference(DaemonConfig{}) + ".SH SEE ALSO\ngannetd(8), gannet(1)\n";
}

}  // namespace gannet::config

#include "src/tool/report_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>

#include "platform/linux/whole_file.hpp"
#include "src/config/rig_file.hpp"
#include "src/tool/report_csv.hpp"

namespace gannet::tool {
namespace {

using control::Json;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostJsonBytes = std::size_t{1} << 26;
constexpr double kDegrees = 180 / std::numbers::pi;

// Reads columns, remembering the first that is missing or wrong.
class Columns {
 public:
  explicit Columns(const CsvTable& table) : table_(table) {}

  std::vector<double> numbers(const std::string& name) {
    auto values = table_.numbers(name);
    if (values) return std::move(*values);
    if (!error_) error_ = values.error();
    return std::vector<double>(table_.rows(), kNone);
  }

  template <class To, class From>
  std::vector<Transform<To, From>> poses(const std::string& of) {
    std::array<std::vector<double>, 7> parts;
    const char* const names[] = {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"};
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = numbers(of + "_" + names[i]);
    std::vector<Transform<To, From>> poses;
    for (std::size_t k = 0; k < table_.rows(); ++k)
      poses.push_back({Quaterniond(parts[3][k], parts[4][k], parts[5][k], parts[6][k]).normalized(),
                       Vector3d(parts[0][k], parts[1][k], parts[2][k])});
    return poses;
  }

  const std::optional<Error>& error() const { return error_; }

 private:
  const CsvTable& table_;
  std::optional<Error> error_;
};

void append(Axes3& axes, const Vector3d& metres) {
  for (std::size_t i = 0; i < 3; ++i)
    axes[i].push_back(1000 * metres[static_cast<Eigen::Index>(i)]);
}

// The reference place is the world's origin, level: there the hand is body_from_hand.
void read_paths(ReportRun& run, Columns& columns) {
  const auto vehicle = columns.poses<World, Body>("vehicle");
  const auto target = columns.poses<Hand, Target>("target");
  const auto body_from_hand = run.rig.body_from_hand.value_or(Transform<Body, Hand>::identity());
  for (std::size_t k = 0; k < vehicle.size(); ++k) {
    const auto world_from_hand = vehicle[k] * body_from_hand;
    const auto reference = [&](const Vector3d& in_hand) {
      const Vector3d in_world = world_from_hand(in_hand);
      return body_from_hand.inverse()(in_world);
    };
    const Vector3d error =
        Vector3d(run.error_mm[0][k], run.error_mm[1][k], run.error_mm[2][k]) / 1000;
    append(run.target_mm, reference(target[k].translation));
    append(run.held_mm, reference(target[k].translation - error));
  }
}

void read_frames(ReportRun& run, Columns& columns) {
  const auto frame = columns.numbers("frame");
  const auto capture_s = columns.numbers("capture_s");
  const auto found = columns.numbers("found");
  const auto fitness = columns.numbers("fitness");
  const auto estimate = columns.poses<LeftCamera, Target>("estimate");
  const auto truth = columns.poses<LeftCamera, Target>("truth");
  double last = 0;
  for (std::size_t k = 0; k < frame.size(); ++k) {
    if (frame[k] == last) continue;
    last = frame[k];
    run.frames.push_back({capture_s[k], found[k] == 1, fitness[k], estimate[k], truth[k]});
  }
}

Result<void> read_trace(ReportRun& run) {
  const auto table = CsvTable::read(run.folder + "/trace.csv");
  if (!table) return table.error();
  if (table->rows() < 2) return Error{run.folder + "/trace.csv: holds less than two rows"};
  Columns columns(*table);
  run.time_s = columns.numbers("time_s");
  const char* const axes[] = {"error_x_m", "error_y_m", "error_z_m"};
  for (std::size_t i = 0; i < 3; ++i) {
    run.error_mm[i] = columns.numbers(axes[i]);
    for (double& e : run.error_mm[i]) e *= 1000;
  }
  run.yaw_deg = columns.numbers("error_yaw_rad");
  for (double& e : run.yaw_deg) e *= kDegrees;
  for (int i = 1; table->has("throttle_" + std::to_string(i)); ++i)
    run.throttle.push_back(columns.numbers("throttle_" + std::to_string(i)));
  read_paths(run, columns);
  read_frames(run, columns);
  if (columns.error()) return *columns.error();
  return {};
}

Result<void> read_events(ReportRun& run) {
  const auto table = CsvTable::read(run.folder + "/events.csv");
  if (!table) return table.error();
  const auto times = table->numbers("time_s");
  if (!times) return times.error();
  const auto texts = table->texts("event");
  if (!texts) return texts.error();
  for (std::size_t i = 0; i < times->size(); ++i) run.events.push_back({(*times)[i], (*texts)[i]});
  return {};
}

Result<void> read_result(ReportRun& run) {
  const std::string path = run.folder + "/result.json";
  const auto bytes = linux_os::read_file(path, kMostJsonBytes);
  if (!bytes) return Error{bytes.error().text + "; a run is recorded by: gannet-world --record"};
  run.result = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
  if (!run.result.is_object()) return Error{path + ": is not a JSON object"};
  const Json* clock = member_at(run.result, "clock");
  if (clock == nullptr || (*clock != "stepped" && *clock != "live"))
    return Error{path + ": 'clock' must be stepped or live"};
  run.stepped = *clock == "stepped";
  return {};
}

}  // namespace

const Json* member_at(const Json& json, std::string_view path) {
  const Json* at = &json;
  while (!path.empty()) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    if (!at->is_object()) return nullptr;
    const auto member = at->find(std::string(path.substr(0, slash)));
    if (member == at->end()) return nullptr;
    at = &*member;
    path.remove_prefix(std::min(slash + 1, path.size()));
  }
  return at;
}

double number_at(const Json& json, std::string_view path) {
  const Json* member = member_at(json, path);
  return member != nullptr && member->is_number() ? member->get<double>() : kNone;
}

std::string ReportRun::scenario() const {
  const Json* name = member_at(result, "scenario");
  return name != nullptr && name->is_string() ? name->get<std::string>() : "unnamed";
}

bool ReportRun::passed() const {
  const Json* passed = member_at(result, "passed");
  return passed != nullptr && *passed == true;
}

double ReportRun::arm_s() const {
  const auto arm = std::find_if(events.begin(), events.end(),
                                [](const ReportEvent& e) { return e.text == "arm"; });
  return arm == events.end() ? 0 : arm->time_s;
}

double ReportRun::settled_s() const { return arm_s() + number_at(result, "measures/settle_s"); }

Result<ReportRun> read_run(const std::string& folder) {
  ReportRun run;
  run.folder = folder;
  if (auto read = read_result(run); !read) return read.error();
  auto rig = config::load_rig(folder + "/rig.toml");
  if (!rig) return rig.error();
  run.rig = std::move(*rig);
  if (auto read = read_events(run); !read) return read.error();
  if (auto read = read_trace(run); !read) return read.error();
  std::error_code ignored;
  if (std::filesystem::exists(folder + "/frames/times.csv", ignored)) {
    auto kept = hal::list_frames(folder + "/frames", 30);
    if (!kept) return kept.error();
    run.pictures = std::move(kept->pairs);
  }
  return run;
}

}  // namespace gannet::tool

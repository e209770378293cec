#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "hal/camera/frame_directory.hpp"
#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/config/rig_file.hpp"
#include "src/report/progress.hpp"
#include "src/report/table.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"
#include "src/track/pose_filter.hpp"
#include "src/track/target_tracker.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet track";
const char* const kHeader =
    "frame,time_s,state,found,x_m,y_m,z_m,qw,qx,qy,qz,sigma_x_m,sigma_y_m,sigma_z_m,sigma_rx,"
    "sigma_ry,sigma_rz,fitness,evaluations,time_ms,model\n";

Command describe_track() {
  const track::TrackConfig preset;
  Command command = {
      .name = kName,
      .summary = "follows targets through a folder of stereo pairs",
      .description =
          "Reads FRAMES/left and FRAMES/right (PNG or JPEG, paired in name order) and, if it is "
          "there, FRAMES/times.csv (frame,time_s). Writes one row for each frame and model: frame, "
          "time, state (searching, locked, coasting, lost), whether it was found, the pose in the "
          "left camera's frame with its standard deviations (m, rad), fitness, evaluations and "
          "time. Pose fields are empty where found is 0. Poses are raw unless --filter is given.",
      .options = {rig_option(),
                  {.name = "model",
                   .value = "FILE",
                   .required = true,
                   .repeats = true,
                   .help = "A target, a .gannet file."},
                  {.name = "csv",
                   .value = "FILE",
                   .help = "Where the rows go; standard output without it."},
                  {.name = "fps",
                   .kind = ArgumentKind::kNumber,
                   .value = "HZ",
                   .min = 0.01,
                   .max = 1000,
                   .unit = "pairs/s",
                   .preset = "30",
                   .help = "Frame rate where there is no times.csv."},
                  {.name = "filter",
                   .kind = ArgumentKind::kFlag,
                   .help = "Poses as the daemon's filter has them at the frame's time."},
                  {.name = "evaluations-tracking",
                   .kind = ArgumentKind::kInteger,
                   .value = "N",
                   .min = 10,
                   .max = 10000000,
                   .unit = "full stereo evaluations",
                   .preset = std::to_string(preset.evaluations_tracking),
                   .help = "Effort for each frame while a target is locked."}},
      .positionals = {{.name = "FRAMES", .required = true, .help = "The folder."}},
      .example = "gannet track --rig rig.toml --model crab.gannet --csv poses.csv recording/",
      .exit_codes = "0  all frames were read\n2  bad input; nothing is written",
      .see_also = "gannet-locate(1), gannet-model-build(1)"};
  command.options = joined(command.options, search_options());
  return command;
}

// One model on its way through the frames.
struct Follower {
  std::string model;
  std::unique_ptr<track::TargetTracker> tracker;
  std::unique_ptr<track::PoseFilter> filter;  // null: raw poses
};

Result<std::vector<Follower>> make_followers(const Arguments& arguments, const StereoRig& rig,
                                             const track::TrackConfig& config) {
  std::vector<Follower> followers;
  for (const std::string& path : arguments.texts("model")) {
    auto model = read_model(path, config);
    if (!model) return model.error();
    Follower follower;
    follower.model = model->name;
    auto tracker = track::TargetTracker::create(config, rig, {std::move(*model)});
    if (!tracker) return tracker.error();
    follower.tracker = std::move(*tracker);
    if (!follower.tracker->choose_model(0, 1)) return Error{path + ": has too many points"};
    if (arguments.flag("filter"))
      follower.filter = std::make_unique<track::PoseFilter>(track::FilterConfig{});
    followers.push_back(std::move(follower));
  }
  return followers;
}

// The filter's view of the target at the frame's own time.
void filter_pose(track::PoseFilter& filter, PoseEstimate& estimate) {
  filter.update(estimate, estimate.capture_time);
  const PredictedPose predicted = filter.predict(estimate.capture_time);
  if (!estimate.found || !predicted.valid) return;
  estimate.left_from_target = predicted.left_from_target;
  estimate.covariance = predicted.covariance.topLeftCorner<6, 6>();
}

std::string pose_columns(const PoseEstimate& estimate) {
  if (!estimate.found) return std::string(13, ',');
  const Eigen::Vector3d& t = estimate.left_from_target.translation;
  const Eigen::Quaterniond q = canonical(estimate.left_from_target.rotation);
  std::string text;
  for (const double value : {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()})
    text += "," + report::number(value, 7);
  for (int i = 0; i < 6; ++i)
    text += "," + report::number(std::sqrt(std::max(0.0, estimate.covariance(i, i))), 7);
  return text;
}

// Names may have commas and quotes.
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

std::string row_of(const hal::FramePair& pair, const PoseEstimate& estimate, double time_ms,
                   const std::string& model) {
  return csv_text(pair.name) + "," + report::number(pair.time_s, 6) + "," +
         to_string(estimate.state) + "," + (estimate.found ? "1" : "0") + pose_columns(estimate) +
         "," + report::number(estimate.fitness, 5) + "," + report::number(estimate.evaluations, 1) +
         "," + report::number(time_ms, 2) + "," + csv_text(model) + "\n";
}

// Rows go to standard output at once, or into a file at the end: all of it or nothing.
class Rows {
 public:
  explicit Rows(std::string path) : path_(std::move(path)) { add(kHeader); }
  void add(const std::string& row) {
    if (path_.empty()) {
      std::fputs(row.c_str(), stdout);
      std::fflush(stdout);
    } else {
      text_ += row;
    }
  }
  Result<void> finish() const {
    return path_.empty() ? Result<void>() : linux_os::write_file(path_, text_);
  }

 private:
  const std::string path_;
  std::string text_;
};

struct Job {
  StereoRig rig;
  hal::FrameDirectory frames;
  std::vector<Follower> followers;
  std::unique_ptr<Parallel> workers;
};

Result<Job> prepare(const Arguments& arguments) {
  Job job;
  auto config = search_config(arguments, false);
  if (!config) return config.error();
  config->evaluations_tracking = arguments.integer("evaluations-tracking");
  auto rig = config::load_rig(arguments.text("rig"));
  if (!rig) return rig.error();
  job.rig = std::move(*rig);
  auto frames = hal::list_frames(arguments.text("FRAMES"), arguments.number("fps"));
  if (!frames) return frames.error();
  job.frames = std::move(*frames);
  auto followers = make_followers(arguments, job.rig, *config);
  if (!followers) return followers.error();
  job.followers = std::move(*followers);
  auto workers = make_workers(arguments.integer("threads"));
  if (!workers) return workers.error();
  job.workers = std::move(*workers);
  return job;
}

Result<void> follow_pair(Job& job, std::size_t index, Rows& rows) {
  const hal::FramePair& pair = job.frames.pairs[index];
  const auto left = read_camera_image(pair.left, job.rig.left, "left");
  if (!left) return left.error();
  const auto right = read_camera_image(pair.right, job.rig.right, "right");
  if (!right) return right.error();
  for (Follower& follower : job.followers) {
    const TimePoint start = linux_os::monotonic_now();
    // One second on, so that a first frame at 0 is not mistaken for no time at all.
    PoseEstimate estimate = follower.tracker->process(
        left->view(), right->view(), time_from_ns(0) + from_seconds(1 + pair.time_s), index + 1, {},
        *job.workers);
    const double time_ms = 1000 * to_seconds(linux_os::monotonic_now() - start);
    if (follower.filter) filter_pose(*follower.filter, estimate);
    rows.add(row_of(pair, estimate, time_ms, follower.model));
  }
  return {};
}

Result<void> follow(const Arguments& arguments) {
  auto job = prepare(arguments);
  if (!job) return job.error();
  Rows rows(arguments.text("csv"));
  report::Progress progress(std::cerr, report::is_terminal(STDERR_FILENO), kName,
                            static_cast<long>(job->frames.pairs.size()), linux_os::monotonic_now());
  for (std::size_t i = 0; i < job->frames.pairs.size(); ++i) {
    if (auto followed = follow_pair(*job, i, rows); !followed) return followed;
    progress.update(static_cast<long>(i) + 1, linux_os::monotonic_now());
  }
  progress.finish(linux_os::monotonic_now());
  return rows.finish();
}

int run(const Arguments& arguments) {
  const auto followed = follow(arguments);
  if (followed) return 0;
  tell(kName, followed.error().text);
  return 2;
}

}  // namespace

Subcommand track_subcommand() { return {describe_track(), &run}; }

}  // namespace gannet::tool

#include "src/tool/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "platform/linux/cpu.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/image_file/image_file.hpp"
#include "src/modeldb/model_file.hpp"

namespace gannet::tool {

constexpr int kMostThreads = 16;  // what a tracker reserves room for

Argument rig_option() {
  return {.name = "rig",
          .value = "RIG",
          .required = true,
          .help = "Calibration of the two cameras, a TOML file."};
}

std::vector<Argument> search_options(const std::string& depths) {
  const track::TrackConfig preset;
  return {
      {.name = depths,
       .kind = ArgumentKind::kNumbers,
       .value = "NEAR:FAR",
       .count = 2,
       .min = 20,
       .max = 100000,
       .unit = "mm",
       .preset = "400:1000",
       .help = "Depths that are searched."},
      {.name = "box-mm",
       .kind = ArgumentKind::kNumbers,
       .value = "X,Y",
       .count = 2,
       .min = 1,
       .max = 100000,
       .unit = "mm",
       .help = "Half-widths of the searched box about the midpoint between the optical axes; "
               "without it the cameras' common field of view."},
      {.name = "tilt-deg",
       .kind = ArgumentKind::kNumber,
       .value = "DEG",
       .min = 0,
       .max = 85,
       .unit = "degrees",
       .preset = "40",
       .help = "Largest turn about x and y; R = Rz Ry Rx."},
      {.name = "roll-deg",
       .kind = ArgumentKind::kNumber,
       .value = "DEG",
       .min = 0,
       .max = 180,
       .unit = "degrees",
       .preset = "45",
       .help = "Largest turn about z."},
      {.name = "fitness",
       .value = "NAME",
       .choices = {"p000", "p001", "p002", "gannet"},
       .preset = "gannet",
       .help = "How a pose is scored: as in the papers (p000 for rectangles, p001 and p002 for "
               "models), or by correlation."},
      {.name = "optimiser",
       .value = "NAME",
       .choices = {"rm_ga", "differential_evolution", "cma_es", "gannet"},
       .preset = "gannet",
       .help = "How poses are searched."},
      {.name = "evaluations",
       .kind = ArgumentKind::kInteger,
       .value = "N",
       .min = 10,
       .max = 10000000,
       .unit = "full stereo evaluations",
       .preset = std::to_string(preset.evaluations),
       .help = "Effort of one search from nothing; there is no deadline."},
      {.name = "threads",
       .kind = ArgumentKind::kInteger,
       .value = "N",
       .min = 0,
       .preset = "0",
       .help = "Threads that share the work, 0: one for each core; more than 16 count as 16; the "
               "answer does not depend on it."},
      {.name = "seed",
       .kind = ArgumentKind::kInteger,
       .value = "N",
       .min = 0,
       .preset = std::to_string(preset.seed),
       .help = "Of the search; the same seed gives the same pose."}};
}

Argument simd_option() {
  return {
      .name = "simd",
      .value = "NAME",
      .preset = "auto",
      .help =
          "Kernels to use: auto, scalar, avx2, avx512, neon; the answer does not depend on them."};
}

std::vector<Argument> joined(std::vector<Argument> a, const std::vector<Argument>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Result<track::TrackConfig> search_config(const Arguments& arguments, bool rectangle,
                                         const std::string& depths) {
  track::TrackConfig config;
  const std::vector<double> z = arguments.numbers(depths);
  if (z[0] >= z[1]) return Error{"--" + depths + ": the far end must be beyond the near one"};
  config.z_min_m = z[0] / 1000;
  config.z_max_m = z[1] / 1000;
  const std::vector<double> box = arguments.numbers("box-mm");
  if (!box.empty()) {
    config.half_width_x_m = box[0] / 1000;
    config.half_width_y_m = box[1] / 1000;
  }
  config.tilt_deg = arguments.number("tilt-deg");
  config.roll_deg = arguments.number("roll-deg");
  config.fitness = arguments.text("fitness");
  config.optimiser = arguments.text("optimiser");
  config.evaluations = arguments.integer("evaluations");
  config.seed = arguments.integer("seed");
  if (rectangle && (config.fitness == "p001" || config.fitness == "p002"))
    return Error{"--fitness: " + config.fitness +
                 " needs a model; with --roi it is p000 or gannet"};
  if (!rectangle && config.fitness == "p000")
    return Error{"--fitness: p000 is for --roi; with a model it is p001, p002 or gannet"};
  return config;
}

namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace

Result<hal::Image> read_camera_image(const std::string& path, const Intrinsics& camera,
                                     const std::string& which) {
  Result<hal::Image> image = image_file::read_image(path);
  if (!image) return image;
  if (image->width() != camera.width || image->height() != camera.height)
    return Error{path + ": is " + size_text(image->width(), image->height()) + " pixels, but the " +
                 which + " camera of the rig has " + size_text(camera.width, camera.height)};
  return image;
}

Result<vision::PatchModel> read_model(const std::string& path, const track::TrackConfig& config) {
  const auto patch = modeldb::load_model(path);
  if (!patch) return patch.error();
  auto model = vision::make_patch_model(*patch, {.inside_points = config.model_points});
  if (!model) return Error{path + ": " + model.error().text};
  return model;
}

Result<std::vector<std::string>> model_files(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".gannet") paths.push_back(entry.path().string());
  if (error) return Error{folder + ": " + error.message()};
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string rolls_text(const vision::Symmetry& symmetry) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  if (symmetry.any_roll) return "any: the target looks the same however it is rolled";
  std::string text;
  for (const double roll : symmetry.rolls)
    text += (text.empty() ? "" : ", ") + std::to_string(std::lround(kDegrees * roll));
  return text.empty() ? "none" : text + " deg: the target cannot be told from itself there";
}

Result<std::unique_ptr<Parallel>> make_workers(int threads) {
  const int wanted = std::min(threads > 0 ? threads : linux_os::core_count(), kMostThreads);
  if (wanted <= 1) return std::unique_ptr<Parallel>(std::make_unique<Serial>());
  auto pool = linux_os::WorkerPool::create(
      "worker", std::vector<linux_os::ThreadConfig>(static_cast<std::size_t>(wanted - 1)));
  if (!pool) return pool.error();
  return std::unique_ptr<Parallel>(std::move(*pool));
}

void tell(const std::string& command, const std::string& text) {
  std::fprintf(stderr, "%s: %s\n", command.c_str(), text.c_str());
}

}  // namespace gannet::tool

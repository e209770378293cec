#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <numbers>
#include <optional>

#include "platform/linux/clock.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/image_file/drawing.hpp"
#include "src/image_file/image_file.hpp"
#include "src/report/progress.hpp"
#include "src/report/table.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/locator.hpp"
#include "src/tool/offline.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet map";
const char* const kDepths = "search-z-mm";

Command describe_map() {
  Command command = {
      .name = kName,
      .summary = "shows how the fitness is distributed over x and y",
      .description =
          "Scores the target at each place of a grid over the cameras' common field of view (or "
          "--box-mm), with depth and orientation fixed: those given, or those of the located "
          "target. Writes a picture (bright is fit) and beside it the numbers as CSV: x_m, y_m, "
          "fitness, in the left camera's frame. One sharp peak at the target is what a recogniser "
          "wants.",
      .options = {rig_option()},
      .example =
          "gannet map --rig rig.toml --left l.png --right r.png --model crab.gannet "
          "--step-mm 5 -o map.png",
      .exit_codes = "0  written\n1  the target was not located\n2  bad input; nothing is written",
      .see_also = "gannet-locate(1)"};
  command.options = joined(command.options, pair_options());
  command.options = joined(
      command.options,
      {{.name = "model", .value = "FILE", .required = true, .help = "The target, a .gannet file."},
       {.name = "step-mm",
        .kind = ArgumentKind::kNumber,
        .value = "MM",
        .min = 0.1,
        .max = 1000,
        .unit = "mm",
        .preset = "5",
        .help = "Distance of the grid's points."},
       {.name = "z-mm",
        .kind = ArgumentKind::kNumber,
        .value = "Z",
        .min = 20,
        .max = 100000,
        .unit = "mm",
        .help = "Score at this depth; without it the target is located first."},
       {.name = "rpy-deg",
        .kind = ArgumentKind::kNumbers,
        .value = "R,P,Y",
        .count = 3,
        .min = -180,
        .max = 180,
        .unit = "degrees",
        .help = "Orientation at the given depth, turns about x, y and z: R = Rz Ry Rx; 0,0,0 "
                "without it."},
       {.name = "output",
        .letter = 'o',
        .value = "FILE",
        .required = true,
        .help = "The picture, a .png; the CSV beside it has the same name with .csv."}});
  command.options = joined(command.options, search_options(kDepths));
  command.options.push_back(simd_option());
  return command;
}

// A grid on the plane at depth z, in the left camera's frame.
struct Grid {
  double x0 = 0;
  double y0 = 0;
  double step = 0;
  int width = 0;
  int height = 0;
};

struct Interval {
  double low;
  double high;
};

// Where the line of sight of a camera's pixel meets the plane at depth z of the left camera.
Eigen::Vector2d on_plane(const Intrinsics& camera, const Transform<LeftCamera, RightCamera>& place,
                         const Eigen::Vector2d& pixel, double z) {
  const Line sight = camera.line(pixel).value_or(Line{});
  const Eigen::Vector3d ray = place.rotation * sight.direction, origin = place(sight.origin);
  return (origin + ray * (z - origin.z()) / ray.z()).head<2>();
}

// What both cameras see along one axis (0: x, 1: y) through the middle of their images.
Interval common_view(const StereoRig& rig, int axis, double z) {
  const Transform<LeftCamera, RightCamera> places[2] = {{}, rig.right_from_left.inverse()};
  const Intrinsics* cameras[2] = {&rig.left, &rig.right};
  Interval common = {-INFINITY, INFINITY};
  for (int eye = 0; eye < 2; ++eye) {
    const Intrinsics& camera = *cameras[eye];
    const double last = (axis == 0 ? camera.width : camera.height) - 1;
    Eigen::Vector2d pixel(camera.cx, camera.cy);
    pixel[axis] = 0;
    const double low = on_plane(camera, places[eye], pixel, z)[axis];
    pixel[axis] = last;
    const double high = on_plane(camera, places[eye], pixel, z)[axis];
    common = {std::max(common.low, low), std::min(common.high, high)};
  }
  return common;
}

Result<Grid> grid_of(const Arguments& arguments, const StereoRig& rig, double z) {
  constexpr int kLargestSide = 4000;
  Grid grid;
  grid.step = arguments.number("step-mm") / 1000;
  Interval sides[2] = {common_view(rig, 0, z), common_view(rig, 1, z)};
  const std::vector<double> box = arguments.numbers("box-mm");
  const Eigen::Vector2d right_axis =
      on_plane(rig.right, rig.right_from_left.inverse(), {rig.right.cx, rig.right.cy}, z);
  for (int axis = 0; axis < 2 && !box.empty(); ++axis) {
    const double half = box[static_cast<std::size_t>(axis)] / 1000;
    sides[axis] = {right_axis[axis] / 2 - half, right_axis[axis] / 2 + half};
  }
  int counts[2] = {};
  for (int axis = 0; axis < 2; ++axis) {
    const double length = sides[axis].high - sides[axis].low;
    if (!(length >= 0)) return Error{"the cameras have no common field of view at that depth"};
    if (length / grid.step > kLargestSide)
      return Error{"--step-mm: gives more than " + std::to_string(kLargestSide) +
                   " points along a side; use a longer step"};
    counts[axis] = static_cast<int>(length / grid.step) + 1;
  }
  grid.width = counts[0];
  grid.height = counts[1];
  grid.x0 = 0.5 * (sides[0].low + sides[0].high - (grid.width - 1) * grid.step);
  grid.y0 = 0.5 * (sides[1].low + sides[1].high - (grid.height - 1) * grid.step);
  return grid;
}

std::vector<double> scores_of(Locator& locator, Transform<LeftCamera, Target> pose,
                              const Grid& grid) {
  std::vector<double> scores;
  std::vector<vision::Hypothesis> row(static_cast<std::size_t>(grid.width));
  std::vector<float> row_scores(row.size());
  report::Progress progress(std::cerr, report::is_terminal(STDERR_FILENO), kName, grid.height,
                            linux_os::monotonic_now());
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      pose.translation.head<2>() << grid.x0 + x * grid.step, grid.y0 + y * grid.step;
      row[static_cast<std::size_t>(x)] = vision::Hypothesis::from(pose);
    }
    locator.recogniser().score(locator.frame(), row, row_scores, locator.workers());
    scores.insert(scores.end(), row_scores.begin(), row_scores.end());
    progress.update(y + 1, linux_os::monotonic_now());
  }
  progress.finish(linux_os::monotonic_now());
  return scores;
}

std::string csv_of(const Grid& grid, const std::vector<double>& scores) {
  std::string text = "x_m,y_m,fitness\n";
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto width = static_cast<std::size_t>(grid.width);
    text += report::number(grid.x0 + static_cast<double>(i % width) * grid.step, 6) + "," +
            report::number(grid.y0 + static_cast<double>(i / width) * grid.step, 6) + "," +
            report::number(scores[i], 6) + "\n";
  }
  return text;
}

// Empty: the target was not located.
std::optional<Transform<LeftCamera, Target>> pose_of(const Arguments& arguments, Locator& locator) {
  Transform<LeftCamera, Target> pose;
  if (!arguments.given("z-mm")) {
    const track::Recognition found = locator.locate().recognition;
    if (!found.found) return std::nullopt;
    return found.left_from_target;
  }
  pose.translation.z() = arguments.number("z-mm") / 1000;
  constexpr double kRadians = std::numbers::pi / 180;
  const std::vector<double> rpy = arguments.numbers("rpy-deg");
  if (!rpy.empty())
    pose.rotation = quaternion_from_rpy(rpy[0] * kRadians, rpy[1] * kRadians, rpy[2] * kRadians);
  return pose;
}

Result<void> write(const std::string& path, const Grid& grid, const std::vector<double>& scores) {
  const auto [low, high] = std::minmax_element(scores.begin(), scores.end());
  const int scale = std::clamp(900 / std::max(grid.width, grid.height), 1, 16);
  const hal::Image picture =
      image_file::heat_map(scores, grid.width, grid.height, *low, *high, scale);
  const std::string csv = path.substr(0, path.size() - 4) + ".csv";
  if (auto written = linux_os::write_file(csv, csv_of(grid, scores)); !written) return written;
  if (auto written = image_file::write_png(path, picture.view()); !written) return written;
  const auto best = static_cast<std::size_t>(high - scores.begin());
  const auto width = static_cast<std::size_t>(grid.width);
  std::printf(
      "%d x %d points, %.3f to %.3f, best at x %.1f, y %.1f mm\nwrote %s and %s\n", grid.width,
      grid.height, *low, *high, 1000 * (grid.x0 + static_cast<double>(best % width) * grid.step),
      1000 * (grid.y0 + static_cast<double>(best / width) * grid.step), path.c_str(), csv.c_str());
  return {};
}

int refuse(const std::string& text) {
  tell(kName, text);
  return 2;
}

int run(const Arguments& arguments) {
  const std::string path = arguments.text("output");
  if (path.size() < 5 || path.substr(path.size() - 4) != ".png")
    return refuse("--output: '" + path + "' does not end in .png");
  if (arguments.given("rpy-deg") && !arguments.given("z-mm"))
    return refuse("--rpy-deg needs --z-mm: together they say the pose");
  auto locator = Locator::create(arguments, kDepths);
  if (!locator) return refuse(locator.error().text);
  const auto pose = pose_of(arguments, *locator);
  if (!pose) {
    tell(kName, "the target was not located; give --z-mm and --rpy-deg");
    return 1;
  }
  const auto grid = grid_of(arguments, locator->rig(), pose->translation.z());
  if (!grid) return refuse(grid.error().text);
  const auto written = write(path, *grid, scores_of(*locator, *pose, *grid));
  return written ? 0 : refuse(written.error().text);
}

}  // namespace

Subcommand map_subcommand() { return {describe_map(), &run}; }

}  // namespace gannet::tool

#include <cmath>
#include <cstdio>
#include <numbers>

#include "src/config/rig_file.hpp"
#include "src/control/json.hpp"
#include "src/modeldb/model_facts.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/report/table.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"
#include "src/vision/symmetry.hpp"

namespace gannet::tool {
namespace {

const char* const kList = "gannet model list";
const char* const kShow = "gannet model show";
constexpr double kDegrees = 180 / std::numbers::pi;

using control::Json;

Command describe_list() {
  return {.name = kList,
          .summary = "lists the models of a folder",
          .description =
              "A model database is a folder of .gannet files. Prints name, size and file "
              "of each, by file name; files that are no models are told and passed over.",
          .options = {{.name = "json", .kind = ArgumentKind::kFlag, .help = "Print as JSON."}},
          .positionals =
              {{.name = "folder", .value = "FOLDER", .required = true, .help = "The folder."}},
          .example = "gannet model list models",
          .exit_codes = "0  listed\n1  some file cannot be read\n2  bad input",
          .see_also = "gannet-model-show(1), gannet-model-build(1)"};
}

Command describe_show() {
  return {.name = kShow,
          .summary = "says what a model's texture is good for",
          .description =
              "Prints size, points, contrast (standard deviations of Y, U and V over the "
              "silhouette) and the rolls at which the target looks like itself, so that no "
              "recogniser can tell them apart. With --rig also the least standard deviations that "
              "one pair of frames can give of each axis (Cramér–Rao: pixels inside the silhouette, "
              "brightness known, target square to the cameras): by these, targets track "
              "differently well.",
          .options = {{.name = "rig", .value = "RIG", .help = "Calibration of the two cameras."},
                      {.name = "depth-mm",
                       .kind = ArgumentKind::kNumber,
                       .value = "MM",
                       .min = 20,
                       .max = 100000,
                       .unit = "mm",
                       .preset = "500",
                       .help = "With --rig: where the target is."},
                      {.name = "noise",
                       .kind = ArgumentKind::kNumber,
                       .value = "LEVELS",
                       .min = 0,
                       .max = 100,
                       .unit = "grey levels",
                       .preset = "3",
                       .help = "With --rig: noise of each pixel and channel."},
                      {.name = "json",
                       .kind = ArgumentKind::kFlag,
                       .help = "Print one JSON object; metres and radians."}},
          .positionals = {{.name = "model",
                           .value = "FILE",
                           .required = true,
                           .help = "The model, a .gannet file."}},
          .example = "gannet model show crab.gannet --rig rig.toml",
          .exit_codes = "0  shown\n2  bad input",
          .see_also = "gannet-model-list(1), gannet-model-build(1)"};
}

int refuse(const char* command, const std::string& text) {
  tell(command, text);
  return 2;
}

std::string millimetres(double metres) { return report::number(1000 * metres, 1); }

int list(const Arguments& arguments) {
  const auto paths = model_files(arguments.text("folder"));
  if (!paths) return refuse(kList, paths.error().text);
  report::Table table({"name", "width mm", "height mm", "file"});
  Json json = Json::array();
  bool all = true;
  for (const std::string& path : *paths) {
    const auto patch = modeldb::load_model(path);
    if (!patch) {
      tell(kList, patch.error().text);
      all = false;
      continue;
    }
    const Eigen::Vector2d size = patch->size_m;
    table.add({patch->name, millimetres(size.x()), millimetres(size.y()), path});
    json.push_back({{"name", patch->name}, {"size_m", {size.x(), size.y()}}, {"file", path}});
  }
  std::printf("%s", arguments.flag("json") ? (json.dump() + "\n").c_str() : table.text().c_str());
  return all ? 0 : 1;
}

// Standard deviations of Y, U, V over the silhouette.
Eigen::Vector3d contrast_of(const vision::PhotoPatch& patch) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = sum;
  int n = 0;
  for (std::size_t i = 0; i < patch.mask.size(); ++i) {
    if (patch.mask[i] == 0) continue;
    const Eigen::Vector3d c(patch.yuv[3 * i], patch.yuv[3 * i + 1], patch.yuv[3 * i + 2]);
    sum += c, squares += c.cwiseAbs2(), ++n;
  }
  return (squares / n - (sum / n).cwiseAbs2()).cwiseMax(0).cwiseSqrt();
}

Json facts_of(const vision::PhotoPatch& patch, const vision::PatchModel& model) {
  const Eigen::Vector3d contrast = contrast_of(patch);
  return {{"name", patch.name},
          {"size_m", {patch.size_m.x(), patch.size_m.y()}},
          {"points_inside", model.inside_count},
          {"points_around", static_cast<int>(model.points.size()) - model.inside_count},
          {"contrast_yuv", {contrast[0], contrast[1], contrast[2]}},
          {"likeness_half_turn", vision::likeness_when_rolled(patch, std::numbers::pi)},
          {"any_roll", model.symmetry.any_roll},
          {"ambiguous_rolls_rad", model.symmetry.rolls}};
}

void print_text(const Json& facts, const vision::PatchModel& model) {
  const auto number = [](const Json& value, double scale, int decimals) {
    return report::number(scale * value.get<double>(), decimals);
  };
  std::printf("%s, %s x %s mm, %d points on it, %d around it\n",
              facts["name"].get<std::string>().c_str(), number(facts["size_m"][0], 1000, 1).c_str(),
              number(facts["size_m"][1], 1000, 1).c_str(), facts["points_inside"].get<int>(),
              facts["points_around"].get<int>());
  const Json& contrast = facts["contrast_yuv"];
  std::printf("contrast of Y, U, V  %s, %s, %s grey levels\n", number(contrast[0], 1, 1).c_str(),
              number(contrast[1], 1, 1).c_str(), number(contrast[2], 1, 1).c_str());
  std::printf("alike at a half turn %s\nambiguous rolls  %s\n",
              number(facts["likeness_half_turn"], 1, 2).c_str(),
              rolls_text(model.symmetry).c_str());
  if (!facts.contains("least_sigma")) return;
  const Json& sigma = facts["least_sigma"];
  if (sigma.is_null()) {
    std::printf("least sigma  none: its texture leaves a direction free, or it is not seen\n");
    return;
  }
  std::printf("least sigma of x, y, z  %s, %s, %s mm; of turns about x, y, z  %s, %s, %s deg\n",
              number(sigma[0], 1000, 3).c_str(), number(sigma[1], 1000, 3).c_str(),
              number(sigma[2], 1000, 3).c_str(), number(sigma[3], kDegrees, 3).c_str(),
              number(sigma[4], kDegrees, 3).c_str(), number(sigma[5], kDegrees, 3).c_str());
}

int show(const Arguments& arguments) {
  const std::string path = arguments.text("model");
  const auto patch = modeldb::load_model(path);
  if (!patch) return refuse(kShow, patch.error().text);
  const auto model = vision::make_patch_model(*patch, {});
  if (!model) return refuse(kShow, path + ": " + model.error().text);
  Json facts = facts_of(*patch, *model);
  if (arguments.given("rig")) {
    const auto rig = config::load_rig(arguments.text("rig"));
    if (!rig) return refuse(kShow, rig.error().text);
    const auto sigma = modeldb::least_sigma(*patch, *rig, arguments.number("depth-mm") / 1000,
                                            arguments.number("noise"));
    facts["least_sigma"] = nullptr;  // x, y, z in metres, turns in radians
    if (sigma) facts["least_sigma"] = std::vector<double>(sigma->data(), sigma->data() + 6);
  }
  if (arguments.flag("json")) {
    std::printf("%s\n", facts.dump().c_str());
  } else {
    print_text(facts, *model);
  }
  return 0;
}

}  // namespace

Subcommand model_list_subcommand() { return {describe_list(), &list}; }
Subcommand model_show_subcommand() { return {describe_show(), &show}; }

}  // namespace gannet::tool

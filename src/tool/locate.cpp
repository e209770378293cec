#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "src/image_file/image_file.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/locator.hpp"
#include "src/tool/offline.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet locate";

Command describe_locate() {
  Command command = {
      .name = kName,
      .summary = "finds a target in one stereo pair, from nothing",
      .description =
          "The target is a model (six degrees of freedom), or a rectangle of the left image, "
          "whose plane is found by comparing both images (depth and two tilts). The pose is the "
          "target's in the left camera's optical frame: x right, y down, z forward.\n"
          "With --json standard output carries one object: found, position_m, quaternion (w, x, y, "
          "z), sigma_m, sigma_rad, fitness, size_m, evaluations, time_ms, model; pose fields are "
          "null when nothing was found.",
      .options = {rig_option()},
      .example =
          "gannet locate --rig rig.toml --left l.png --right r.png --model crab.gannet "
          "--overlay seen.png\n"
          "gannet locate --rig rig.toml --left l.png --right r.png --roi 250,180,96,80 "
          "--z-mm 500:3000 --json",
      .exit_codes = "0  found\n1  not found\n2  bad input",
      .see_also = "gannet-model-build(1), gannet-track(1), gannet-map(1)"};
  command.options = joined(command.options, pair_options());
  command.options =
      joined(command.options,
             {{.name = "model", .value = "FILE", .help = "What to look for: a .gannet file."},
              {.name = "roi",
               .kind = ArgumentKind::kIntegers,
               .value = "X,Y,W,H",
               .count = 4,
               .unit = "pixels",
               .help = "What to look for: this rectangle of the left image."}});
  command.options = joined(command.options, search_options());
  command.options = joined(
      command.options,
      {simd_option(),
       {.name = "json", .kind = ArgumentKind::kFlag, .help = "Print the answer as JSON."},
       {.name = "overlay",
        .value = "FILE",
        .help = "Write both images with outline and axes (x red, y green, z blue) as a PNG."}});
  return command;
}

void print_json(const control::Json& json) { std::printf("%s\n", json.dump().c_str()); }

int refuse(bool json, const std::string& text) {
  if (json) print_json(json_of_error(text));
  tell(kName, text);
  return 2;
}

void tell_bad_arguments(std::span<const std::string> args, const std::string& text) {
  const bool json = std::find(args.begin(), args.end(), "--json") != args.end();
  if (json) print_json(json_of_error(text));
}

// Before the search: where nothing is found, no picture would show that it could not be written.
Result<void> check_overlay(const Arguments& arguments) {
  const std::string path = arguments.text("overlay");
  if (!path.ends_with(".png")) return Error{"--overlay: '" + path + "' does not end in .png"};
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  for (const char* input : {"rig", "left", "right", "model"}) {
    if (std::filesystem::equivalent(path, arguments.text(input), error))
      return Error{"--overlay: '" + path + "' is the input --" + input + "; name another file"};
  }
  if (folder.empty() || std::filesystem::is_directory(folder, error)) return {};
  return Error{"--overlay: '" + path + "': there is no folder '" + folder.string() + "'"};
}

int run(const Arguments& arguments) {
  const bool json = arguments.flag("json");
  if (arguments.given("overlay")) {
    if (const auto usable = check_overlay(arguments); !usable)
      return refuse(json, usable.error().text);
  }
  auto locator = Locator::create(arguments);
  if (!locator) return refuse(json, locator.error().text);
  const Answer answer = locator->locate();
  const track::Recognition& r = answer.recognition;
  // The picture of an earlier search must not pass for this one's.
  if (arguments.given("overlay") && !r.found) {
    std::error_code nothing_there;
    std::filesystem::remove(arguments.text("overlay"), nothing_there);
  }
  if (arguments.given("overlay") && r.found) {
    const hal::Image picture = locator->overlay(r.left_from_target, r.size_m);
    const auto written = image_file::write_png(arguments.text("overlay"), picture.view());
    if (!written) return refuse(json, written.error().text);
  }
  if (json) {
    print_json(json_of(answer));
  } else {
    std::printf("%s", text_of(answer).c_str());
  }
  return r.found ? 0 : 1;
}

}  // namespace

Subcommand locate_subcommand() { return {describe_locate(), &run, &tell_bad_arguments}; }

}  // namespace gannet::tool

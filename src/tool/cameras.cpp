#include "src/tool/cameras.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "src/tool/inputs.hpp"

namespace gannet::tool {
namespace {

namespace fs = std::filesystem;
using control::Json;

constexpr const char* kName = "gannet cameras";

Command describe_cameras() {
  return {.name = kName,
          .summary = "lists V4L2 cameras: formats, sizes, rates, controls",
          .description =
              "Formats marked \"not usable\" are none that camera.v4l2_pair.format and "
              "camera.v4l2_side_by_side.format can name. Controls are listed as their `controls` "
              "take them. Name cameras by their link in /dev/v4l/by-path: the numbers of "
              "/dev/video may change at each boot.",
          .options = {{.name = "all",
                       .kind = ArgumentKind::kFlag,
                       .help = "Also devices that give no images, such as metadata nodes."},
                      {.name = "json", .kind = ArgumentKind::kFlag, .help = "Print JSON."}},
          .positionals = {{.name = "device",
                           .repeats = true,
                           .help = "Only these; without any, all of /dev/video*."}},
          .example = "gannet cameras\ngannet cameras --json /dev/video0",
          .exit_codes =
              "0  some were found\n1  none was found\n2  bad input, or a named device "
              "cannot be read",
          .see_also = "gannet(1), gannet.toml(5)"};
}

// By number: video2 before video10.
std::vector<std::string> device_files() {
  std::vector<std::string> paths;
  std::error_code error;
  for (fs::directory_iterator it("/dev", error), end; !error && it != end; it.increment(error))
    if (it->path().filename().string().rfind("video", 0) == 0) paths.push_back(it->path());
  std::sort(paths.begin(), paths.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return paths;
}

std::vector<std::string> links_to(const std::string& path) {
  std::vector<std::string> links;
  std::error_code error;
  const fs::path device = fs::weakly_canonical(path, error);
  for (const char* folder : {"/dev/v4l/by-path", "/dev/v4l/by-id"})
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
      if (fs::weakly_canonical(it->path(), error) == device) links.push_back(it->path());
  std::sort(links.begin(), links.end());
  return links;
}

Json json_of(const hal::V4l2Range& range) {
  if (range.min == range.max) return range.min;
  return {{"min", range.min}, {"max", range.max}, {"step", range.step}};
}

Json json_of(const hal::V4l2OfferedFormat& format) {
  Json json = {{"format", format.name},
               {"usable", format.is_known},
               {"description", format.description},
               {"sizes", Json::array()}};
  for (const auto& size : format.sizes)
    json["sizes"].push_back({{"width", json_of(size.width)},
                             {"height", json_of(size.height)},
                             {"rates_hz", size.rates_hz},
                             {"any_rate_between", size.any_rate_between}});
  return json;
}

Json json_of(const hal::V4l2Control& control) {
  Json json = {{"name", control.name},
               {"min", control.min},
               {"max", control.max},
               {"step", control.step},
               {"default", control.default_value},
               {"value", control.value ? Json(*control.value) : Json()}};
  for (const auto& [index, name] : control.menu) json["menu"][std::to_string(index)] = name;
  return json;
}

int run(const Arguments& arguments) {
  std::vector<std::string> paths = arguments.texts("device");
  const bool named = !paths.empty();
  if (!named) paths = device_files();
  std::vector<FoundCamera> cameras;
  int failed = 0;
  for (const std::string& path : paths) {
    FoundCamera camera = look_at(hal::kernel_v4l2(), path);
    if (!camera.problem.empty()) {
      tell(kName, camera.problem);
      ++failed;
    } else if (camera.offer.captures || named || arguments.flag("all")) {
      camera.links = links_to(path);
      cameras.push_back(std::move(camera));
    }
  }
  const std::string text =
      arguments.flag("json") ? json_of(cameras).dump() + "\n" : text_of(cameras);
  std::fputs(text.c_str(), stdout);
  if (named && failed > 0) return 2;
  if (cameras.empty() && failed == 0) tell(kName, "no V4L2 camera is here");
  return cameras.empty() ? 1 : 0;
}

}  // namespace

FoundCamera look_at(hal::V4l2System& system, const std::string& path) {
  FoundCamera camera;
  camera.path = path;
  const int fd = system.open(path);
  if (fd < 0) {
    camera.problem = path + ": cannot open: " + std::strerror(-fd);
    return camera;
  }
  auto offer = hal::read_offer(system, fd, path);
  if (offer) {
    camera.offer = std::move(*offer);
    camera.controls = hal::list_controls(system, fd);
  } else {
    camera.problem = offer.error().text;
  }
  system.close(fd);
  return camera;
}

control::Json json_of(const std::vector<FoundCamera>& cameras) {
  Json json = {{"cameras", Json::array()}};
  for (const FoundCamera& camera : cameras) {
    Json one = {{"device", camera.path},           {"links", camera.links},
                {"card", camera.offer.card},       {"driver", camera.offer.driver},
                {"bus", camera.offer.bus},         {"gives_images", camera.offer.captures},
                {"streams", camera.offer.streams}, {"formats", Json::array()},
                {"controls", Json::array()}};
    for (const auto& format : camera.offer.formats) one["formats"].push_back(json_of(format));
    for (const auto& control : camera.controls) one["controls"].push_back(json_of(control));
    json["cameras"].push_back(std::move(one));
  }
  return json;
}

std::string text_of(const std::vector<FoundCamera>& cameras) {
  std::string text;
  for (const FoundCamera& camera : cameras) {
    if (!text.empty()) text += "\n";
    text += camera.path + "  " + camera.offer.card + " (" + camera.offer.driver + ", " +
            camera.offer.bus + ")\n";
    for (const std::string& link : camera.links) text += "  = " + link + "\n";
    if (!camera.offer.captures)
      text += "  gives no images\n";
    else if (!camera.offer.streams)
      text += "  has no mapped buffers, cannot be used\n";
    const std::string formats = hal::text_of(camera.offer, "  ");
    if (!formats.empty()) text += formats + "\n";
    if (!camera.controls.empty()) text += "  controls\n";
    for (const auto& control : camera.controls) text += "    " + hal::text_of(control) + "\n";
    if (hal::moves_the_hue(camera.controls))
      text += "  its automatic white balance is on, which moves the hue\n";
  }
  return text;
}

Subcommand cameras_subcommand() { return {describe_cameras(), &run}; }

}  // namespace gannet::tool

#include "src/modeldb/model_file.hpp"

#include <algorithm>
#include <string_view>

#include "platform/linux/whole_file.hpp"
#include "src/config/loader.hpp"
#include "src/config/printer.hpp"
#include "src/image_file/png.hpp"

namespace gannet::modeldb {
namespace {

constexpr std::size_t kLargestFile = std::size_t{1} << 28;
constexpr std::string_view kFirstLine = "# gannet model\n";
constexpr std::string_view kSeparator = "\n---\n";

struct CameraFacts {
  double fx = 0;
  double fy = 0;
};

struct BackgroundFacts {
  std::vector<double> yuv = {0, 128, 128};
  int hue = 0;
};

struct PhotoFacts {
  std::string colour_space = "yuv-bt601-full";
  std::vector<double> origin_px = {0, 0};
  int bytes = 0;
};

struct Header {
  std::string name;
  std::vector<double> size_m = {0, 0};
  double distance_m = 0;
  CameraFacts camera;
  BackgroundFacts background;
  PhotoFacts photo;
};

void describe(Visitor& v, CameraFacts& c) {
  v.field("fx", c.fx,
          {.min = 1, .max = 1e6, .unit = "px", .help = "Focal length of the photo, horizontal."});
  v.field("fy", c.fy, {.min = 1, .max = 1e6, .unit = "px", .help = "The same, vertical."});
}

void describe(Visitor& v, BackgroundFacts& c) {
  v.field("yuv", c.yuv,
          {.min = 0, .max = 255, .size = 3, .help = "Mean colour of the background."});
  v.field("hue", c.hue,
          {.min = 0, .max = 255, .help = "Its mean hue, 256 steps a circle, weighted by chroma."});
}

void describe(Visitor& v, PhotoFacts& c) {
  v.field("colour_space", c.colour_space,
          {.choices = {"yuv-bt601-full"},
           .help = "What the three channels of the picture are: Y, U, V."});
  v.field("origin_px", c.origin_px,
          {.min = 0,
           .max = 16384,
           .size = 2,
           .unit = "px",
           .help = "The target's origin in the crop; (0, 0) is the centre of the first pixel."});
  v.field("bytes", c.bytes,
          {.min = 1,
           .max = static_cast<double>(kLargestFile),
           .unit = "bytes",
           .help = "Length of the picture behind the header."});
}

void describe(Visitor& v, Header& c) {
  v.field("name", c.name, {.help = "The target's name."});
  v.field("size_m", c.size_m,
          {.min = 1e-4,
           .max = 1000,
           .size = 2,
           .unit = "m",
           .help = "Width and height of the target's bounding box."});
  v.field("distance_m", c.distance_m,
          {.min = 1e-3,
           .max = 1000,
           .unit = "m",
           .help = "From the camera to the target's plane when the photo was taken."});
  v.group("camera", c.camera,
          "Facts of the camera that took the photo; the crop has no distortion.");
  v.group("background", c.background, "What was around the target.");
  v.group("photo", c.photo, "The picture behind the header.");
}

Header header_of(const vision::PhotoPatch& patch, std::size_t bytes) {
  Header h;
  h.name = patch.name;
  h.size_m = {patch.size_m.x(), patch.size_m.y()};
  h.distance_m = patch.distance_m;
  h.camera = {patch.fx, patch.fy};
  const vision::Yuv& b = patch.background;
  h.background = {{b.y, b.u, b.v}, patch.background_hue};
  h.photo.origin_px = {patch.centre_px.x(), patch.centre_px.y()};
  h.photo.bytes = static_cast<int>(bytes);
  return h;
}

Result<Header> read_header(std::string_view text, const std::string& name) {
  const auto tree = config::parse_toml(text, name);
  if (!tree) return tree.error();
  Header header;
  config::Origins origins;
  config::Problems problems;
  config::load(*tree, name, header, origins, problems);
  for (const char* key : {"name", "size_m", "distance_m", "camera.fx", "camera.fy",
                          "background.yuv", "background.hue", "photo.origin_px", "photo.bytes"})
    if (problems.empty() && origins.count(key) == 0)
      problems.add({name, 0}, std::string("the header has no ") + key);
  if (problems.empty() && !is_model_name(header.name))
    problems.add(origins["name"], "name: is empty, too long or has invisible characters");
  if (!problems.empty()) return problems.error();
  return header;
}

vision::PhotoPatch patch_of(const Header& h, const image_file::Raster8& picture) {
  vision::PhotoPatch patch;
  patch.name = h.name;
  patch.width = picture.width;
  patch.height = picture.height;
  for (std::size_t i = 0; i + 3 < picture.samples.size(); i += 4) {
    patch.yuv.insert(patch.yuv.end(), &picture.samples[i], &picture.samples[i] + 3);
    patch.mask.push_back(picture.samples[i + 3]);
  }
  patch.distance_m = h.distance_m;
  patch.fx = h.camera.fx;
  patch.fy = h.camera.fy;
  patch.centre_px = {h.photo.origin_px[0], h.photo.origin_px[1]};
  patch.size_m = {h.size_m[0], h.size_m[1]};
  patch.background = {static_cast<float>(h.background.yuv[0]),
                      static_cast<float>(h.background.yuv[1]),
                      static_cast<float>(h.background.yuv[2])};
  patch.background_hue = static_cast<std::uint8_t>(h.background.hue);
  return patch;
}

image_file::Raster8 picture_of(const vision::PhotoPatch& patch) {
  image_file::Raster8 picture(patch.width, patch.height, 4);
  for (std::size_t i = 0; i < patch.mask.size(); ++i) {
    std::copy_n(&patch.yuv[3 * i], 3, &picture.samples[4 * i]);
    picture.samples[4 * i + 3] = patch.mask[i] != 0 ? 255 : 0;
  }
  return picture;
}

}  // namespace

bool is_model_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 && std::none_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

Result<std::vector<std::uint8_t>> encode_model(const vision::PhotoPatch& patch) {
  const auto picture = image_file::encode_png(picture_of(patch));
  if (!picture) return Error{patch.name + ": " + picture.error().text};
  const std::string header =
      std::string(kFirstLine) + config::commented_file(header_of(patch, picture->size())) + "---\n";
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  bytes.insert(bytes.end(), picture->begin(), picture->end());
  return bytes;
}

Result<vision::PhotoPatch> decode_model(std::span<const std::uint8_t> bytes,
                                        const std::string& name) {
  // The bytes are text as far as the separator; looking at them as text harms nobody.
  const std::string text(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                            bytes.size(), std::size_t{1} << 16)));
  if (text.rfind(kFirstLine, 0) != 0)
    return Error{name + ": is not a gannet model; `gannet model build` makes one"};
  const std::size_t end = text.find(kSeparator);
  if (end == std::string::npos)
    return Error{name + ": ends within its header; it is cut off, build it again"};
  const auto header = read_header(std::string_view(text).substr(0, end + 1), name);
  if (!header) return header.error();
  const std::size_t start = end + kSeparator.size();
  const auto wanted = static_cast<std::size_t>(header->photo.bytes);
  if (bytes.size() - start != wanted)
    return Error{name + ": byte " + std::to_string(bytes.size()) + ": the picture has " +
                 std::to_string(bytes.size() - start) + " bytes instead of " +
                 std::to_string(wanted) + "; the file is damaged, build it again"};
  const auto picture = image_file::decode_png8(bytes.subspan(start), 4);
  if (!picture) return Error{name + ": its picture: " + picture.error().text};
  vision::PhotoPatch patch = patch_of(*header, *picture);
  if (std::all_of(patch.mask.begin(), patch.mask.end(), [](std::uint8_t m) { return m == 0; }))
    return Error{name + ": its mask is empty; build it again"};
  if (patch.centre_px.x() >= patch.width || patch.centre_px.y() >= patch.height)
    return Error{name + ": photo.origin_px: lies outside the picture"};
  return patch;
}

Result<vision::PhotoPatch> load_model(const std::string& path) {
  const auto bytes = linux_os::read_file(path, kLargestFile);
  if (!bytes) return bytes.error();
  return decode_model(*bytes, path);
}

Result<void> save_model(const std::string& path, const vision::PhotoPatch& patch) {
  const auto bytes = encode_model(patch);
  if (!bytes) return bytes.error();
  return linux_os::write_file(path, *bytes);
}

std::string model_reference() { return config::markdown_reference(Header{}); }

}  // namespace gannet::modeldb

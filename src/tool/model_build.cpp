#include <cstdio>
#include <optional>

#include "src/config/rig_file.hpp"
#include "src/image_file/image_file.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"
#include "src/tool/preview.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet model build";

Command describe_model_build() {
  return {
      .name = kName,
      .summary = "makes a model of a target from a photo",
      .description =
          "The photo is taken by the left camera, squarely, at a known distance. The silhouette is "
          "where the photo differs from one of the background alone, or what a mask says; one of "
          "both is enough. Prints the number of points and the size, and writes a preview beside "
          "the model: check its outline.",
      .options = {rig_option(),
                  {.name = "target", .value = "PHOTO", .required = true, .help = "The photo."},
                  {.name = "distance-mm",
                   .kind = ArgumentKind::kNumber,
                   .value = "MM",
                   .min = 1,
                   .max = 100000,
                   .unit = "mm",
                   .preset = "400",
                   .help = "From the camera to the target's plane."},
                  {.name = "background",
                   .value = "PHOTO",
                   .help = "The same view without the target."},
                  {.name = "mask",
                   .value = "FILE",
                   .help = "Picture of the photo's size, non-zero (or opaque) where the target "
                           "is."},
                  {.name = "origin",
                   .kind = ArgumentKind::kNumbers,
                   .value = "U,V",
                   .count = 2,
                   .unit = "pixels",
                   .help = "The point of the photo that poses are of: the target's origin. The "
                           "middle of the silhouette's box unless told."},
                  {.name = "points",
                   .kind = ArgumentKind::kInteger,
                   .value = "N",
                   .min = 50,
                   .max = 2000,
                   .preset = "800",
                   .help = "Points inside the silhouette that are reported; recognition chooses "
                           "its own."},
                  {.name = "name", .value = "NAME", .required = true, .help = "The target's name."},
                  {.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .required = true,
                   .help = "The model, a .gannet file; an old one is replaced when all is well."}},
      .example =
          "gannet model build --rig rig.toml --target photo.png --background empty.png "
          "--distance-mm 400 --name crab -o crab.gannet",
      .exit_codes = "0  the model is written\n2  bad input; nothing is written",
      .see_also = "gannet-locate(1), gannet-track(1)"};
}

// The silhouette's room takes masks as the Y plane of a picture.
hal::Image picture_of_mask(const image_file::Raster8& mask) {
  hal::Image picture(mask.width, mask.height, hal::PixelFormat::kYuv444);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      picture.row(0, y)[x] = *mask.at(x, y) != 0 ? 255 : 0;
      picture.row(1, y)[x] = picture.row(2, y)[x] = 128;
    }
  return picture;
}

struct Photos {
  hal::Image target;
  std::optional<hal::Image> background;
  std::optional<hal::Image> mask;
};

Result<Photos> read_photos(const Arguments& arguments, const Intrinsics& camera) {
  Photos photos;
  Result<hal::Image> target = read_camera_image(arguments.text("target"), camera, "left");
  if (!target) return target.error();
  photos.target = std::move(*target);
  if (arguments.given("background")) {
    Result<hal::Image> image = read_camera_image(arguments.text("background"), camera, "left");
    if (!image) return image.error();
    photos.background = std::move(*image);
  }
  if (arguments.given("mask")) {
    const Result<image_file::Raster8> mask = image_file::read_mask(arguments.text("mask"));
    if (!mask) return mask.error();
    photos.mask = picture_of_mask(*mask);
  }
  return photos;
}

Result<vision::PhotoPatch> build(const Arguments& arguments) {
  if (!arguments.given("background") && !arguments.given("mask"))
    return Error{"--background or --mask is missing: one says where the target is"};
  if (!modeldb::is_model_name(arguments.text("name")))
    return Error{"--name: must be 1 to 64 visible characters"};
  const auto rig = config::load_rig(arguments.text("rig"));
  if (!rig) return rig.error();
  const auto photos = read_photos(arguments, rig->left);
  if (!photos) return photos.error();
  const hal::ImageView background =
      photos->background ? photos->background->view() : hal::ImageView{};
  const hal::ImageView mask = photos->mask ? photos->mask->view() : hal::ImageView{};
  const std::string subject =
      arguments.text("target") + (photos->mask ? " with " + arguments.text("mask") : "");
  std::optional<Eigen::Vector2d> origin;
  if (arguments.given("origin")) {
    const auto uv = arguments.numbers("origin");
    origin = Eigen::Vector2d(uv[0], uv[1]);
  }
  auto patch = vision::cut_out({.target = photos->target.view(),
                                .background = photos->background ? &background : nullptr,
                                .mask = photos->mask ? &mask : nullptr,
                                .distance_m = arguments.number("distance-mm") / 1000,
                                .name = subject,  // what an error is about
                                .origin_px = origin},
                               rig->left);
  if (patch) patch->name = arguments.text("name");
  return patch;
}

// "models/crab.gannet" → "models/crab-preview.png"
std::string preview_path(const std::string& path) {
  const std::string ending = ".gannet";
  const bool has = path.size() > ending.size() &&
                   path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  return (has ? path.substr(0, path.size() - ending.size()) : path) + "-preview.png";
}

Result<vision::PatchModel> build_and_write(const Arguments& arguments) {
  const auto patch = build(arguments);
  if (!patch) return patch.error();
  auto model = vision::make_patch_model(*patch, {.inside_points = arguments.integer("points")});
  if (!model) return model;
  const std::string output = arguments.text("output");
  if (auto written = modeldb::save_model(output, *patch); !written) return written.error();
  const hal::Image preview = draw_preview(*patch, *model);
  if (auto written = image_file::write_png(preview_path(output), preview.view()); !written)
    return written.error();
  return model;
}

int run(const Arguments& arguments) {
  const auto model = build_and_write(arguments);
  if (!model) {
    tell(kName, model.error().text);
    return 2;
  }
  const int outside = static_cast<int>(model->points.size()) - model->inside_count;
  std::printf("%s: %d points on the target, %d around it, %.1f x %.1f mm\n", model->name.c_str(),
              model->inside_count, outside, 1000 * model->size_m.x(), 1000 * model->size_m.y());
  if (model->symmetry.exists())
    std::printf("ambiguous rolls  %s\n", rolls_text(model->symmetry).c_str());
  std::printf("wrote %s and %s\n", arguments.text("output").c_str(),
              preview_path(arguments.text("output")).c_str());
  return 0;
}

}  // namespace

Subcommand model_build_subcommand() { return {describe_model_build(), &run}; }

}  // namespace gannet::tool

#include "src/tool/locator.hpp"

#include "platform/linux/clock.hpp"
#include "src/config/rig_file.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/tool/inputs.hpp"

namespace gannet::tool {
namespace {

Result<vision::Rectangle> rectangle_of(const std::vector<int>& roi, const Intrinsics& camera) {
  const vision::Rectangle r = {roi[0], roi[1], roi[2], roi[3]};
  const std::string image =
      std::to_string(camera.width) + "x" + std::to_string(camera.height) + " image";
  if (r.width < 8 || r.height < 8) return Error{"--roi: the rectangle must be at least 8x8 pixels"};
  // Differences, because sums of what people type may overflow.
  if (r.x < 0 || r.y < 0 || r.x >= camera.width || r.y >= camera.height ||
      r.width > camera.width - r.x || r.height > camera.height - r.y)
    return Error{"--roi: the rectangle lies outside the " + image};
  return r;
}

}  // namespace

std::vector<Argument> pair_options() {
  return {{.name = "left", .value = "FILE", .required = true, .help = "Left image, PNG or JPEG."},
          {.name = "right", .value = "FILE", .required = true, .help = "Right image."}};
}

Result<void> Locator::read_images(const Arguments& arguments) {
  auto left = read_camera_image(arguments.text("left"), rig_.left, "left");
  if (!left) return left.error();
  auto right = read_camera_image(arguments.text("right"), rig_.right, "right");
  if (!right) return right.error();
  if (left->width() != right->width() || left->height() != right->height())
    return Error{arguments.text("right") + ": the two images must be of the same size"};
  left_ = std::move(*left);
  right_ = std::move(*right);
  return {};
}

Result<void> Locator::choose_target(const Arguments& arguments, const track::TrackConfig& config) {
  const auto kind = rectangle_ ? track::TargetKind::kRectangle : track::TargetKind::kModel;
  auto recogniser =
      track::Recogniser::create(config, rig_, kind, workers_->workers(), arguments.text("simd"));
  if (!recogniser) return recogniser.error();
  recogniser_ = std::move(*recogniser);
  std::optional<vision::PatchModel> model;
  if (patch_) {
    auto made = vision::make_patch_model(*patch_, {.inside_points = config.model_points});
    if (!made) return Error{arguments.text("model") + ": " + made.error().text};
    model = std::move(*made);
  }
  const TimePoint start = linux_os::monotonic_now();
  frame_ =
      std::make_unique<vision::PreparedFrame>(left_.width(), left_.height(), recogniser_->needs());
  if (!frame_->prepare(left_.view(), right_.view())) return Error{"the images cannot be used"};
  const bool taken =
      model ? recogniser_->set_model(*model) : recogniser_->set_rectangle(*rectangle_, *frame_);
  if (!taken) return Error{"the target has too many points"};
  preparation_ = linux_os::monotonic_now() - start;
  return {};
}

Result<Locator> Locator::create(const Arguments& arguments, const std::string& depths) {
  Locator made;
  const bool has_roi = arguments.knows("roi") && arguments.given("roi");
  if (has_roi == arguments.given("model"))
    return Error{"one of --model and --roi says what to look for"};
  const auto config = search_config(arguments, has_roi, depths);
  if (!config) return config.error();
  auto rig = config::load_rig(arguments.text("rig"));
  if (!rig) return rig.error();
  made.rig_ = std::move(*rig);
  if (has_roi) {
    const auto rectangle = rectangle_of(arguments.integers("roi"), made.rig_.left);
    if (!rectangle) return rectangle.error();
    made.rectangle_ = *rectangle;
  } else {
    auto patch = modeldb::load_model(arguments.text("model"));
    if (!patch) return patch.error();
    made.patch_ = std::move(*patch);
  }
  if (auto read = made.read_images(arguments); !read) return read.error();
  auto workers = make_workers(arguments.integer("threads"));
  if (!workers) return workers.error();
  made.workers_ = std::move(*workers);
  if (auto chosen = made.choose_target(arguments, *config); !chosen) return chosen.error();
  return made;
}

Answer Locator::locate() {
  Answer answer;
  const TimePoint start = linux_os::monotonic_now();
  answer.recognition = recogniser_->recognise(*frame_, nullptr, {}, *workers_);
  answer.time_ms = 1000 * to_seconds(linux_os::monotonic_now() - start + preparation_);
  if (patch_) answer.model = patch_->name;
  return answer;
}

std::vector<Segment> Locator::outline(const Transform<LeftCamera, Target>& pose) const {
  return patch_ ? outline_of(*patch_) : outline_of(*rectangle_, rig_.left, pose);
}

hal::Image Locator::overlay(const Transform<LeftCamera, Target>& pose,
                            const Eigen::Vector2d& size_m) const {
  return draw_overlay(left_, right_, rig_, pose, outline(pose), 0.5 * size_m.minCoeff());
}

}  // namespace gannet::tool

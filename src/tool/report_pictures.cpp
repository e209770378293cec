#include "src/tool/report_pictures.hpp"

#include <algorithm>
#include <cmath>

#include "src/image_file/drawing.hpp"
#include "src/image_file/image_file.hpp"
#include "src/image_file/jpeg.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/report/table.hpp"
#include "src/tool/preview.hpp"

namespace gannet::tool {
namespace {

using report::number;

constexpr double kSameTime_s = 1e-3;

const ReportFrame* frame_at(const ReportRun& run, double time_s) {
  for (const ReportFrame& frame : run.frames)
    if (frame.found && std::abs(frame.capture_s - time_s) < kSameTime_s) return &frame;
  return nullptr;
}

// The model that the events had chosen by then.
std::string model_at(const ReportRun& run, double time_s) {
  const std::string verb = "target ";
  std::string name;
  for (const ReportEvent& event : run.events)
    if (event.time_s <= time_s && event.text.rfind(verb, 0) == 0)
      name = event.text.substr(verb.size());
  return run.folder + "/" + name + ".gannet";
}

// Pairs that show something, by times that lie closer together at the beginning.
std::vector<const hal::FramePair*> chosen(const ReportRun& run, int most) {
  std::vector<const hal::FramePair*> usable;
  for (const hal::FramePair& pair : run.pictures)
    if (frame_at(run, pair.time_s) != nullptr) usable.push_back(&pair);
  if (static_cast<int>(usable.size()) <= most || most < 2) return usable;
  const double first_s = usable.front()->time_s;
  const double span_s = usable.back()->time_s - first_s;
  std::vector<const hal::FramePair*> picked;
  for (int i = 0; i < most; ++i) {
    const double wanted_s = first_s + span_s * std::pow(static_cast<double>(i) / (most - 1), 2.5);
    const auto nearest = *std::min_element(usable.begin(), usable.end(), [&](auto* a, auto* b) {
      return std::abs(a->time_s - wanted_s) < std::abs(b->time_s - wanted_s);
    });
    if (picked.empty() || picked.back() != nearest) picked.push_back(nearest);
  }
  return picked;
}

std::size_t row_at(const ReportRun& run, double time_s) {
  const auto row = std::lower_bound(run.time_s.begin(), run.time_s.end(), time_s - kSameTime_s);
  return std::min(static_cast<std::size_t>(row - run.time_s.begin()), run.time_s.size() - 1);
}

Result<ReportPicture> draw(const ReportRun& run, const hal::FramePair& pair) {
  ReportPicture picture;
  picture.time_s = pair.time_s;
  picture.frame = frame_at(run, pair.time_s);
  const std::size_t row = row_at(run, pair.time_s);
  picture.distance_mm =
      std::hypot(run.error_mm[0][row], run.error_mm[1][row], run.error_mm[2][row]);
  picture.yaw_deg = run.yaw_deg[row];
  const auto model = modeldb::load_model(model_at(run, pair.time_s));
  if (!model) return model.error();
  const auto left = image_file::read_image(pair.left);
  if (!left) return left.error();
  const auto right = image_file::read_image(pair.right);
  if (!right) return right.error();
  picture.image = draw_overlay(*left, *right, run.rig, picture.frame->estimate, outline_of(*model),
                               0.4 * model->size_m.minCoeff());
  return picture;
}

}  // namespace

Result<std::vector<ReportPicture>> run_pictures(const ReportRun& run, int most) {
  std::vector<ReportPicture> pictures;
  for (const hal::FramePair* pair : chosen(run, most)) {
    auto picture = draw(run, *pair);
    if (!picture) return picture.error();
    pictures.push_back(std::move(*picture));
  }
  return pictures;
}

std::string caption_of(const ReportPicture& picture) {
  const Eigen::Vector3d found = 1000 * picture.frame->estimate.translation;
  const Eigen::Vector3d truth = 1000 * picture.frame->truth.translation;
  const auto place = [](const Eigen::Vector3d& p) {
    return "(" + number(p.x(), 1) + ", " + number(p.y(), 1) + ", " + number(p.z(), 1) + ") mm";
  };
  return number(picture.time_s, 1) + " s: " + number(picture.distance_mm, 1) + " mm and " +
         number(std::abs(picture.yaw_deg), 1) + "° from the goal. Recognised at " + place(found) +
         ", truth " + place(truth) + " in the left camera; fitness " +
         number(picture.frame->fitness, 3);
}

hal::Image before_and_after(const ReportPicture& before, const ReportPicture& after) {
  constexpr int kGap = 4;
  const int width = (before.image.width() - kGap) / 2;
  hal::Image both(2 * width + kGap, before.image.height(), hal::PixelFormat::kRgb24);
  image_file::Canvas canvas(both);
  canvas.fill(image_file::colours::kWhite);
  canvas.blit(before.image.view(), 0, 0);
  canvas.blit(after.image.view(), width + kGap, 0);  // its right eye falls off the border
  const auto words = [](const ReportPicture& p) {
    return number(p.time_s, 1) + " s: " + number(p.distance_mm, p.distance_mm < 10 ? 1 : 0) +
           " mm, " + number(std::abs(p.yaw_deg), 1) + "° from the goal";
  };
  canvas.label(12, 12, words(before), image_file::colours::kWhite, 2);
  canvas.label(width + kGap + 12, 12, words(after), image_file::colours::kWhite, 2);
  return both;
}

Result<std::vector<std::uint8_t>> jpeg_of(const hal::Image& image, int quality) {
  return image_file::encode_jpeg(image.view(), quality);
}

}  // namespace gannet::tool

#include "src/tool/report_stereo.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "platform/linux/whole_file.hpp"
#include "src/config/rig_file.hpp"
#include "src/image_file/drawing.hpp"
#include "src/image_file/image_file.hpp"
#include "src/tool/preview.hpp"
#include "src/tool/report_csv.hpp"
#include "src/tool/report_run.hpp"

namespace gannet::tool {
namespace {

using control::Json;
using Eigen::Vector3d;
using report::number;

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kGap = 4;  // pixels between the eyes

double angle_deg_between(const Vector3d& a, const Vector3d& b) {
  return kDegrees * std::atan2(a.cross(b).norm(), a.dot(b));
}

bool is_rectified(const StereoRig& rig) {
  const Intrinsics& l = rig.left;
  const Intrinsics& r = rig.right;
  const Vector3d t = rig.right_from_left.translation;
  return !l.port && !r.port && l.fx == r.fx && l.fy == r.fy && l.cy == r.cy &&
         l.distortion == Distortion::kNone && r.distortion == Distortion::kNone && t.x() < 0 &&
         t.y() == 0 && t.z() == 0 &&
         rig.right_from_left.rotation.angularDistance(Eigen::Quaterniond::Identity()) < 1e-9;
}

// Least squares of d = a u + b v + c over the known disparities.
struct DisparityPlane {
  Vector3d abc = Vector3d::Zero();
  double residual_px = 0;
  int count = 0;
};

DisparityPlane fit(const FloatMap& disparity, const vision::Rectangle& r) {
  DisparityPlane plane;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  double squares = 0;
  for (int v = r.y; v < r.y + r.height; ++v)
    for (int u = r.x; u < r.x + r.width; ++u) {
      const double d = static_cast<double>(disparity.at(u, v));
      if (!std::isfinite(d)) continue;
      const Vector3d row(u, v, 1);
      normal += row * row.transpose();
      right += row * d;
      squares += d * d;
      plane.count += 1;
    }
  if (plane.count < 3) return plane;
  plane.abc = normal.ldlt().solve(right);
  const double left_over = squares - plane.abc.dot(right);
  plane.residual_px = std::sqrt(std::max(left_over, 0.0) / plane.count);
  return plane;
}

Result<void> read_answer(const std::string& path, StereoAnswer& answer) {
  const auto bytes = linux_os::read_file(path, std::size_t{1} << 20);
  if (!bytes) return bytes.error();
  const Json json = Json::parse(bytes->begin(), bytes->end(), nullptr, false);
  const Json* found = member_at(json, "found");
  if (found == nullptr || !found->is_boolean())
    return Error{path + ": is no answer of gannet locate --json"};
  answer.found = found->get<bool>();
  answer.fitness = number_at(json, "fitness");
  answer.time_ms = number_at(json, "time_ms");
  if (!answer.found) return {};
  const auto list = [&](const char* key, std::size_t size) {
    const Json* values = member_at(json, key);
    std::vector<double> numbers;
    if (values != nullptr && values->is_array())
      for (const Json& value : *values)
        if (value.is_number()) numbers.push_back(value.get<double>());
    numbers.resize(size, std::nan(""));
    return numbers;
  };
  const auto p = list("position_m", 3), q = list("quaternion", 4), s = list("sigma_m", 3);
  answer.pose = {Eigen::Quaterniond(q[0], q[1], q[2], q[3]), Vector3d(p[0], p[1], p[2])};
  answer.sigma_z_m = s[2];
  return {};
}

Result<std::vector<StereoAnswer>> read_rectangles(const std::string& path) {
  const auto table = CsvTable::read(path);
  if (!table) return table.error();
  const auto names = table->texts("name");
  if (!names) return names.error();
  std::array<std::vector<double>, 4> sides;
  const char* const columns[] = {"x", "y", "width", "height"};
  for (std::size_t i = 0; i < 4; ++i) {
    auto numbers = table->numbers(columns[i]);
    if (!numbers) return numbers.error();
    sides[i] = std::move(*numbers);
  }
  std::vector<StereoAnswer> answers(table->rows());
  for (std::size_t k = 0; k < answers.size(); ++k) {
    for (const auto& side : sides)
      if (std::abs(side[k]) > hal::kMaxImageSide)
        return Error{path + ":" + std::to_string(k + 2) + ": the rectangle lies outside any image"};
    answers[k].name = (*names)[k];
    answers[k].rectangle = {static_cast<int>(sides[0][k]), static_cast<int>(sides[1][k]),
                            static_cast<int>(sides[2][k]), static_cast<int>(sides[3][k])};
  }
  return answers;
}

// The found plane's piece in both eyes, with its number.
void draw(image_file::Canvas& canvas, const StereoRig& rig, const StereoAnswer& answer, int index) {
  const auto outline = outline_of(answer.rectangle, rig.left, answer.pose);
  const auto pixel = [&](const Eigen::Vector2d& on_target, bool right_eye) {
    const Vector3d in_left = answer.pose(Vector3d(on_target.x(), on_target.y(), 0));
    const auto at =
        right_eye ? rig.right.project(rig.right_from_left(in_left)) : rig.left.project(in_left);
    const double first = right_eye ? rig.left.width + kGap : 0;
    return at ? image_file::Point{at->x() + first, at->y()} : image_file::Point{-1, -1};
  };
  for (const bool right_eye : {false, true}) {
    for (const Segment& s : outline)
      canvas.line(pixel(s.from, right_eye), pixel(s.to, right_eye), image_file::colours::kYellow,
                  2);
    const auto corner = pixel(outline.front().from, right_eye);
    canvas.label(static_cast<int>(corner.x) + 5, static_cast<int>(corner.y) + 5,
                 std::to_string(index), image_file::colours::kWhite, 2);
  }
}

}  // namespace

double TruePlane::slant_deg() const { return angle_deg_between(normal, Vector3d::UnitZ()); }

Result<TruePlane> plane_of(const FloatMap& disparity, const vision::Rectangle& r,
                           const StereoRig& rig) {
  if (!is_rectified(rig)) return Error{"the pair is not rectified: disparity tells no depth"};
  if (r.x < 0 || r.y < 0 || r.width < 2 || r.height < 2 || r.x + r.width > disparity.width ||
      r.y + r.height > disparity.height)
    return Error{"the rectangle lies outside the disparity map"};
  const DisparityPlane plane = fit(disparity, r);
  if (2 * plane.count < r.width * r.height)
    return Error{"the disparity is known in less than half of the rectangle"};
  // Z = f B / (d + cx_right − cx_left), with u = cx + f X / Z put into d(u, v).
  const Intrinsics& c = rig.left;
  const double shift_px = rig.right.cx - c.cx;
  const double a = plane.abc.x(), b = plane.abc.y();
  const Vector3d centre(r.x + 0.5 * (r.width - 1), r.y + 0.5 * (r.height - 1), 1);
  TruePlane truth;
  truth.depth_m = c.fx * rig.baseline_m() / (plane.abc.dot(centre) + shift_px);
  truth.normal =
      Vector3d(a * c.fx, b * c.fy, a * c.cx + b * c.cy + plane.abc.z() + shift_px).normalized();
  truth.residual_px = plane.residual_px;
  return truth;
}

double StereoAnswer::depth_error() const { return pose.translation.z() / truth.depth_m - 1; }

double StereoAnswer::angle_deg() const {
  return angle_deg_between(pose.rotation * Vector3d::UnitZ(), truth.normal);
}

bool StereoAnswer::passed() const { return found && std::abs(depth_error()) <= kDepthLimit; }

bool ReportStereo::passed() const {
  return std::all_of(answers.begin(), answers.end(), [](const auto& a) { return a.passed(); });
}

report::Table ReportStereo::table() const {
  report::Table table({"", "rectangle", "true depth, mm", "found, mm", "error, mm", "error, %",
                       "σ, mm", "slant, °", "normals apart, °", "fitness", "time, ms", "verdict"});
  int index = 0;
  for (const StereoAnswer& a : answers) {
    std::vector<std::string> row = {std::to_string(++index), a.name,
                                    number(1000 * a.truth.depth_m, 0)};
    if (a.found) {
      const double z_mm = 1000 * a.pose.translation.z();
      for (const auto& [value, decimals] : {std::pair{z_mm, 0},
                                            {z_mm - 1000 * a.truth.depth_m, 1},
                                            {100 * a.depth_error(), 2},
                                            {1000 * a.sigma_z_m, 1},
                                            {a.truth.slant_deg(), 0},
                                            {a.angle_deg(), 1}})
        row.push_back(number(value, decimals));
    } else {
      row.insert(row.end(), {"not found", "–", "–", "–", number(a.truth.slant_deg(), 0), "–"});
    }
    row.insert(row.end(),
               {number(a.fitness, 3), number(a.time_ms, 0), a.passed() ? "pass" : "fail"});
    table.add(std::move(row));
  }
  return table;
}

Result<ReportStereo> read_stereo(const std::string& folder) {
  ReportStereo stereo;
  auto rig = config::load_rig(folder + "/rig.toml");
  if (!rig) return rig.error();
  stereo.rig = std::move(*rig);
  const auto disparity = read_npy(folder + "/disparity.npy");
  if (!disparity) return disparity.error();
  auto answers = read_rectangles(folder + "/rectangles.csv");
  if (!answers) return answers.error();
  stereo.answers = std::move(*answers);
  const auto left = image_file::read_image(folder + "/left.png");
  if (!left) return left.error();
  const auto right = image_file::read_image(folder + "/right.png");
  if (!right) return right.error();
  stereo.picture = image_file::side_by_side(left->view(), right->view(), kGap);
  image_file::Canvas canvas(stereo.picture);
  int index = 0;
  for (StereoAnswer& answer : stereo.answers) {
    const auto truth = plane_of(*disparity, answer.rectangle, stereo.rig);
    if (!truth)
      return Error{folder + "/rectangles.csv: " + answer.name + ": " + truth.error().text};
    answer.truth = *truth;
    const auto read = read_answer(folder + "/" + answer.name + ".json", answer);
    if (!read) return read.error();
    ++index;
    if (answer.found) draw(canvas, stereo.rig, answer, index);
  }
  return stereo;
}

}  // namespace gannet::tool

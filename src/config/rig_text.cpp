#include <cstddef>
#include <string>
#include <vector>

#include "src/config/rig_file.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {
namespace {

std::string line_of(const char* key, double value) {
  return std::string(key) + " = " + value_text(value) + "\n";
}

std::string port_text(const std::string& camera, const FlatPort& port) {
  const Eigen::Vector3d& n = port.normal;
  return "[" + camera + ".port]\nnormal = " + value_text(std::vector<double>{n.x(), n.y(), n.z()}) +
         "\n" + line_of("distance_m", port.distance_m) + line_of("thickness_m", port.thickness_m) +
         line_of("air_index", port.air_index) + line_of("glass_index", port.glass_index) +
         line_of("water_index", port.water_index) + "\n";
}

std::string camera_text(const std::string& name, const Intrinsics& camera) {
  static const char* const kDistortions[] = {"none", "brown", "fisheye"};
  static const int kCoefficients[] = {0, 5, 4};
  const auto kind = static_cast<std::size_t>(camera.distortion);
  const auto first = camera.coefficients.begin();
  const std::vector<double> coefficients(first, first + kCoefficients[kind]);
  return "[" + name + "]\nwidth = " + value_text(camera.width) +
         "\nheight = " + value_text(camera.height) + "\nfx = " + value_text(camera.fx) +
         "\nfy = " + value_text(camera.fy) + "\ncx = " + value_text(camera.cx) +
         "\ncy = " + value_text(camera.cy) + "\ndistortion = \"" + kDistortions[kind] +
         "\"\ncoefficients = " + value_text(coefficients) + "\n" +
         (camera.time_offset == Duration{}
              ? ""
              : line_of("time_offset_s", to_seconds(camera.time_offset))) +
         "\n" + (camera.port ? port_text(name, *camera.port) : "");
}

template <class To, class From>
std::string transform_text(const std::string& name, const Transform<To, From>& transform) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> r = transform.rotation.toRotationMatrix();
  const Eigen::Vector3d& t = transform.translation;
  return "[" + name + "]\nrotation = " + value_text(std::vector<double>(r.data(), r.data() + 9)) +
         "\ntranslation_m = " + value_text(std::vector<double>{t.x(), t.y(), t.z()}) + "\n\n";
}

}  // namespace

std::string rig_text(const StereoRig& rig) {
  std::string text = camera_text("left", rig.left) + camera_text("right", rig.right) +
                     transform_text("right_from_left", rig.right_from_left) +
                     transform_text("hand_from_left", rig.hand_from_left);
  if (rig.body_from_hand) text += transform_text("body_from_hand", *rig.body_from_hand);
  return text;
}

}  // namespace gannet::config

#include "src/config/rig_file.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <vector>

#include "src/config/loader.hpp"
#include "src/config/printer.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {
namespace {

struct PortTable {
  std::vector<double> normal = {0, 0, 1};
  double distance_m = FlatPort{}.distance_m;
  double thickness_m = FlatPort{}.thickness_m;
  double air_index = FlatPort{}.air_index;
  double glass_index = FlatPort{}.glass_index;
  double water_index = FlatPort{}.water_index;
};

struct CameraTable {
  int width = 640;
  int height = 480;
  double fx = 640;
  double fy = 640;
  double cx = 319.5;
  double cy = 239.5;
  std::string distortion = "none";
  std::vector<double> coefficients;
  double time_offset_s = 0;
  PortTable port;
};

struct MotionTable {
  std::vector<double> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::vector<double> translation_m = {0, 0, 0};
};

struct RigTables {
  CameraTable left;
  CameraTable right;
  MotionTable right_from_left;
  MotionTable hand_from_left;
  MotionTable body_from_hand;
};

constexpr double kFar = 1e6;

void describe(Visitor& v, PortTable& c) {
  v.field("normal", c.normal,
          {.min = -1.01,
           .max = 1.01,
           .size = 3,
           .help = "Across the glass, into the water, in the camera's optical axes; length 1."});
  v.field("distance_m", c.distance_m,
          {.min = 0,
           .max = 1,
           .unit = "m",
           .help = "From the camera's centre to the glass, along the normal."});
  v.field("thickness_m", c.thickness_m,
          {.min = 0, .max = 0.2, .unit = "m", .help = "Of the glass."});
  v.field("air_index", c.air_index,
          {.min = 1, .max = 2.5, .help = "Index of refraction inside the housing."});
  v.field("glass_index", c.glass_index,
          {.min = 1, .max = 2.5, .help = "Of the glass: acrylic 1.49, borosilicate 1.47."});
  v.field("water_index", c.water_index,
          {.min = 1,
           .max = 2.5,
           .help = "Of the water: fresh 1.333, sea 1.34; 1 where the housing looks into air."});
}

void describe(Visitor& v, CameraTable& c) {
  v.field("width", c.width, {.min = 16, .max = 16384, .unit = "px", .help = "Image width."});
  v.field("height", c.height, {.min = 16, .max = 16384, .unit = "px", .help = "Image height."});
  v.field("fx", c.fx, {.min = 1, .max = kFar, .unit = "px", .help = "Focal length, horizontal."});
  v.field("fy", c.fy, {.min = 1, .max = kFar, .unit = "px", .help = "Focal length, vertical."});
  v.field("cx", c.cx,
          {.min = -kFar,
           .max = kFar,
           .unit = "px",
           .help = "Principal point; 0 is the centre of the first pixel."});
  v.field("cy", c.cy, {.min = -kFar, .max = kFar, .unit = "px", .help = "The same, downwards."});
  v.field("distortion", c.distortion,
          {.choices = {"none", "brown", "fisheye"},
           .help = "Lens model: none, brown (Brown–Conrady) or fisheye (Kannala–Brandt)."});
  v.field("coefficients", c.coefficients,
          {.help = "brown: k1 k2 p1 p2 k3; fisheye: k1 k2 k3 k4; none: empty. OpenCV's order."});
  v.field("time_offset_s", c.time_offset_s,
          {.min = -1,
           .max = 1,
           .unit = "s",
           .help = "Added to the driver's time stamp to give the middle of the exposure."});
  v.group("port", c.port,
          "Optional: the flat port of a housing before the camera, which refracts. The keys above "
          "are then those of the camera in air.");
}

void describe(Visitor& v, MotionTable& c) {
  v.field("rotation", c.rotation,
          {.min = -1.01, .max = 1.01, .size = 9, .help = "Rotation matrix, row by row."});
  v.field("translation_m", c.translation_m,
          {.min = -1000, .max = 1000, .size = 3, .unit = "m", .help = "Translation."});
}

void describe(Visitor& v, RigTables& c) {
  v.group("left", c.left, "The left camera.");
  v.group("right", c.right, "The right camera; the same keys.");
  v.group("right_from_left", c.right_from_left,
          "Where the left camera's points are for the right one: r_right = R r_left + t.");
  v.group("hand_from_left", c.hand_from_left,
          "Optional: the hand frame, in which goals are told; optical axes. Without it, midway "
          "between the cameras with the axes of the left one.");
  v.group("body_from_hand", c.body_from_hand,
          "Where the cameras sit on the vehicle: body axes x forward, y left, z up. Needed by "
          "gannetd as soon as there is a vehicle.");
}

// One reading of a file: its tables, where they came from, what was wrong with them.
struct Reading {
  RigTables tables;
  Origins origins;
  Problems problems;
  std::string name;

  bool has(const std::string& key) const { return origins.count(key) > 0; }
  // The line of the key, else of its table, else the file.
  Origin where(const std::string& key) const {
    for (std::string at = key; !at.empty();) {
      const auto found = origins.find(at);
      if (found != origins.end()) return found->second;
      const std::size_t dot = at.rfind('.');
      at.resize(dot == std::string::npos ? 0 : dot);
    }
    return {name, 0};
  }
  void refuse(const std::string& key, const std::string& text) {
    problems.add(where(key), key + ": " + text);
  }
};

void require(Reading& r, const std::string& table, const std::vector<const char*>& keys) {
  if (!r.has(table)) return r.problems.add({r.name, 0}, "the table [" + table + "] is missing");
  for (const char* key : keys)
    if (!r.has(table + "." + key)) r.refuse(table + "." + key, "is missing");
}

void require_all(Reading& r) {
  for (const char* camera : {"left", "right"})
    require(r, camera, {"width", "height", "fx", "fy", "cx", "cy"});
  const std::vector<const char*> motion = {"rotation", "translation_m"};
  require(r, "right_from_left", motion);
  for (const char* optional : {"hand_from_left", "body_from_hand"})
    if (r.has(optional)) require(r, optional, motion);
  for (const char* port : {"left.port", "right.port"})
    if (r.has(port)) require(r, port, {"normal", "distance_m", "thickness_m"});
}

// A file that tells of a port in the wrong place must not be taken for one without.
void refuse_port(TomlValue& root, Reading& r) {
  const auto at = std::find_if(root.members.begin(), root.members.end(),
                               [](const TomlValue& member) { return member.name == "port"; });
  if (at == root.members.end()) return;
  if (at->kind != TomlValue::Kind::kTable || !at->members.empty())
    r.problems.add({r.name, at->line},
                   "port: each camera has its own: write [left.port] and [right.port]");
  root.members.erase(at);
}

// Files carry few digits, so the length is made good; what is far from 1 is refused.
FlatPort port_of(const PortTable& table, const std::string& key, Reading& r) {
  const Eigen::Vector3d normal(table.normal[0], table.normal[1], table.normal[2]);
  if (!(std::abs(normal.norm() - 1) < 2e-3)) {
    r.refuse(key + ".normal", "is not a unit vector: its length is " + number_text(normal.norm()));
    return {};
  }
  return {normal.normalized(), table.distance_m,  table.thickness_m,
          table.air_index,     table.glass_index, table.water_index};
}

Intrinsics camera_of(const CameraTable& table, const std::string& key, Reading& r) {
  Intrinsics camera;
  camera.width = table.width;
  camera.height = table.height;
  camera.fx = table.fx;
  camera.fy = table.fy;
  camera.cx = table.cx;
  camera.cy = table.cy;
  camera.time_offset = from_seconds(table.time_offset_s);
  if (r.has(key + ".port")) camera.port = port_of(table.port, key + ".port", r);
  std::size_t wanted = 0;
  std::string names;
  if (table.distortion == "brown") {
    camera.distortion = Distortion::kBrown;
    wanted = 5;
    names = " (k1 k2 p1 p2 k3)";
  } else if (table.distortion == "fisheye") {
    camera.distortion = Distortion::kFisheye;
    wanted = 4;
    names = " (k1 k2 k3 k4)";
  }
  if (table.coefficients.size() != wanted) {
    r.refuse(key + ".coefficients", "has " + std::to_string(table.coefficients.size()) +
                                        " elements; distortion \"" + table.distortion +
                                        "\" takes " + std::to_string(wanted) + names);
    return camera;
  }
  std::copy(table.coefficients.begin(), table.coefficients.end(), camera.coefficients.begin());
  return camera;
}

// Files carry few digits, so the nearest rotation is taken; what is far from any is refused.
template <class To, class From>
Transform<To, From> motion_of(const MotionTable& table, const std::string& key, Reading& r) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Matrix3d matrix = Eigen::Map<const Rows>(table.rotation.data());
  const Eigen::Matrix3d off = matrix * matrix.transpose() - Eigen::Matrix3d::Identity();
  const double worst = off.cwiseAbs().maxCoeff();
  if (worst > 2e-3) {
    r.refuse(key + ".rotation",
             "is not a rotation: its rows are not of length 1 and square to "
             "each other (off by " +
                 number_text(worst) + ")");
    return {};
  }
  if (matrix.determinant() < 0) {
    r.refuse(key + ".rotation", "is not a rotation: it mirrors (determinant −1)");
    return {};
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  return {canonical(Eigen::Quaterniond(nearest).normalized()),
          Eigen::Map<const Eigen::Vector3d>(table.translation_m.data())};
}

// All that looks at a pair goes over both images at once.
void require_one_size(const StereoRig& rig, Reading& r) {
  const auto compare = [&r](const char* key, int right, int left) {
    if (right != left)
      r.refuse(key, std::to_string(right) + " px must be the left camera's, " +
                        std::to_string(left) + " px");
  };
  compare("right.width", rig.right.width, rig.left.width);
  compare("right.height", rig.right.height, rig.left.height);
}

StereoRig rig_of(Reading& r) {
  StereoRig rig;
  rig.left = camera_of(r.tables.left, "left", r);
  rig.right = camera_of(r.tables.right, "right", r);
  rig.right_from_left =
      motion_of<RightCamera, LeftCamera>(r.tables.right_from_left, "right_from_left", r);
  if (r.has("hand_from_left")) {
    rig.hand_from_left = motion_of<Hand, LeftCamera>(r.tables.hand_from_left, "hand_from_left", r);
  } else {
    const Eigen::Vector3d right_camera = rig.right_from_left.inverse().translation;
    rig.hand_from_left.translation = -0.5 * right_camera;
  }
  if (r.has("body_from_hand"))
    rig.body_from_hand = motion_of<Body, Hand>(r.tables.body_from_hand, "body_from_hand", r);
  return rig;
}

Result<StereoRig> read(TomlValue root, const std::string& name) {
  Reading r;
  r.name = name;
  refuse_port(root, r);
  load(root, name, r.tables, r.origins, r.problems);
  if (!r.problems.empty()) return r.problems.error();
  require_all(r);
  if (!r.problems.empty()) return r.problems.error();
  StereoRig rig = rig_of(r);
  require_one_size(rig, r);
  if (!r.problems.empty()) return r.problems.error();
  for (const RigProblem& problem : problems_of(rig)) r.refuse(problem.key, problem.text);
  if (!r.problems.empty()) return r.problems.error();
  return rig;
}

}  // namespace

Result<StereoRig> parse_rig(std::string_view text, const std::string& name) {
  Result<TomlValue> root = parse_toml(text, name);
  if (!root) return root.error();
  return read(std::move(*root), name);
}

Result<StereoRig> load_rig(const std::string& path) {
  Result<TomlValue> root = read_toml(path);
  if (!root) return root.error();
  return read(std::move(*root), path);
}

std::string rig_reference() { return markdown_reference(RigTables{}); }

}  // namespace gannet::config

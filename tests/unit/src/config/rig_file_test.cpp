#include "src/config/rig_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace gannet::config {
namespace {

const std::string kLeft =
    "[left]\nwidth = 640\nheight = 480\nfx = 640.0\nfy = 641.0\ncx = 319.5\ncy = 239.5\n"
    "distortion = \"none\"\ncoefficients = []\n";  // lines 1 to 9
const std::string kRight =
    "[right]\nwidth = 640\nheight = 480\nfx = 600\nfy = 600\ncx = 320\ncy = 240\n";
const std::string kMotion =
    "[right_from_left]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\ntranslation_m = [-0.12, 0, 0]\n";
const std::string kGood = kLeft + kRight + kMotion;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string error_of(const std::string& text) {
  const auto rig = parse_rig(text, "rig.toml");
  return rig ? "none" : rig.error().text;
}

TEST(RigFile, reads_what_the_contract_shows) {
  const auto sut = parse_rig(kGood, "rig.toml");
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->left.width, 640);
  EXPECT_EQ(sut->left.fy, 641);
  EXPECT_EQ(sut->right.fx, 600);
  EXPECT_NEAR(sut->baseline_m(), 0.12, 1e-12);
  EXPECT_FALSE(sut->body_from_hand);
}

TEST(RigFile, the_hand_is_midway_between_the_cameras_by_default) {
  const std::string turned =
      replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[0, 0, 1, 0, 1, 0, -1, 0, 0]");
  for (const std::string& text : {kGood, turned}) {
    const auto sut = parse_rig(text, "rig.toml");
    ASSERT_TRUE(sut) << sut.error().text;
    const Eigen::Vector3d right_camera = sut->right_from_left.inverse().translation;
    EXPECT_LT(sut->hand_from_left(0.5 * right_camera).norm(), 1e-12);
    EXPECT_LT((sut->right_from_left(right_camera)).norm(), 1e-12);
    EXPECT_NEAR(sut->hand_from_left.rotation.w(), 1, 1e-12);
  }
  const auto sut = parse_rig(kGood, "rig.toml");
  EXPECT_NEAR(sut->hand_from_left.translation.x(), -0.06, 1e-12);
}

TEST(RigFile, rotation_is_row_by_row) {
  // Rows of a quarter turn about z: x_right = −y_left, y_right = x_left.
  const auto sut = parse_rig(
      replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[0, -1, 0, 1, 0, 0, 0, 0, 1]"), "rig.toml");
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_LT((sut->right_from_left({0, 1, 0}) - Eigen::Vector3d(-1.12, 0, 0)).norm(), 1e-12);
}

TEST(RigFile, distortion_offset_and_frames_are_read) {
  const auto sut = parse_rig(
      replaced(replaced(kGood, "\"none\"\ncoefficients = []",
                        "\"brown\"\ncoefficients = [-0.3, 0.1, 0.001, 0.002, -0.02]\n"
                        "time_offset_s = -0.004"),
               "cy = 240\n",
               "cy = 240\ndistortion = \"fisheye\"\ncoefficients = [0.1, 0.2, 0.3, 0.4]\n") +
          "[hand_from_left]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\ntranslation_m = [0, 0, 1]\n"
          "[body_from_hand]\nrotation = [0, 0, 1, -1, 0, 0, 0, -1, 0]\n"
          "translation_m = [0.2, 0, 0]\n[port]\n",
      "rig.toml");
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(sut->left.distortion, Distortion::kBrown);
  EXPECT_EQ(sut->left.coefficients, (std::array<double, 5>{-0.3, 0.1, 0.001, 0.002, -0.02}));
  EXPECT_EQ(sut->left.time_offset, from_seconds(-0.004));
  EXPECT_EQ(sut->right.distortion, Distortion::kFisheye);
  EXPECT_EQ(sut->hand_from_left.translation.z(), 1);
  ASSERT_TRUE(sut->body_from_hand);
  // Optical axes on a vehicle that looks forward: ahead is body x, image right is starboard.
  EXPECT_LT(((*sut->body_from_hand)({0, 0, 1}) - Eigen::Vector3d(1.2, 0, 0)).norm(), 1e-12);
  EXPECT_LT(((*sut->body_from_hand)({1, 0, 0}) - Eigen::Vector3d(0.2, -1, 0)).norm(), 1e-12);
}

TEST(RigFile, few_digits_of_a_rotation_are_enough) {
  const auto sut = parse_rig(replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]",
                                      "[0.9998, 0, 0.0175, 0, 1, 0, -0.0175, 0, 0.9998]"),
                             "rig.toml");
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_NEAR(sut->right_from_left.rotation.norm(), 1, 1e-15);
  EXPECT_NEAR(2 * std::asin(sut->right_from_left.rotation.y()), 0.0175, 1e-4);
}

TEST(RigFile, each_fault_is_told_with_its_line) {
  EXPECT_EQ(error_of(replaced(kGood, "fx = 640.0", "fx = 0")),
            "rig.toml:4: left.fx: 0 px is outside [1, 1000000]");
  EXPECT_EQ(error_of(replaced(kGood, "fy = 641.0\n", "")), "rig.toml:1: left.fy: is missing");
  EXPECT_EQ(error_of(kLeft + kRight), "rig.toml: the table [right_from_left] is missing");
  EXPECT_EQ(error_of(replaced(kGood, "\"none\"", "\"brown\"")),
            "rig.toml:9: left.coefficients: has 0 elements; distortion \"brown\" takes 5 "
            "(k1 k2 p1 p2 k3)");
  EXPECT_EQ(error_of(replaced(kGood, "coefficients = []", "coefficients = [0.1]")),
            "rig.toml:9: left.coefficients: has 1 elements; distortion \"none\" takes 0");
  EXPECT_EQ(error_of(replaced(kGood, "-0.12, 0, 0", "0, 0, 0")),
            "rig.toml:19: right_from_left.translation_m: gives a baseline outside [0.0001, 100] m; "
            "two cameras stand apart");
  EXPECT_EQ(error_of(replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[1, 0, 0, 0, 1, 0, 0, 0]")),
            "rig.toml:18: right_from_left.rotation: has 8 elements instead of 9");
  EXPECT_EQ(
      error_of(replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[1, 0, 0, 0, 1, 0, 0, 0, -1]")),
      "rig.toml:18: right_from_left.rotation: is not a rotation: it mirrors (determinant −1)");
  EXPECT_EQ(
      error_of(replaced(kGood, "[1, 0, 0, 0, 1, 0, 0, 0, 1]", "[1, 0.1, 0, 0, 1, 0, 0, 0, 1]"))
          .substr(0, 61),
      "rig.toml:18: right_from_left.rotation: is not a rotation: its");
  EXPECT_EQ(error_of(replaced(kGood, "fx = 640.0", "fx = nan")),
            "rig.toml:4: left.fx: is not a finite number");
  EXPECT_EQ(error_of(replaced(kGood, "cx = 319.5", "cx = 31950")),
            "rig.toml:6: left.cx: is farther from the image than the image is wide");
  EXPECT_EQ(error_of(replaced(kGood, "height", "heigth")),
            "rig.toml:3: left.heigth: unknown key (did you mean height?)");
}

TEST(RigFile, both_cameras_have_one_size) {
  EXPECT_EQ(error_of(kLeft + replaced(kRight, "width = 640", "width = 320") + kMotion),
            "rig.toml:11: right.width: 320 px must be the left camera's, 640 px");
  EXPECT_EQ(error_of(kLeft + replaced(kRight, "height = 480", "height = 400") + kMotion),
            "rig.toml:12: right.height: 400 px must be the left camera's, 480 px");
}

const std::string kPort =
    "[left.port]\nnormal = [0.0131, -0.00446, 0.9999]\n"
    "distance_m = 0.0253\nthickness_m = 0.008\n";  // lines 20 to 23

TEST(RigFile, ports_are_read_each_for_its_camera) {
  const auto sut = parse_rig(
      kGood + kPort + "water_index = 1.34\nair_index = 1.0003\nglass_index = 1.47\n", "rig.toml");
  ASSERT_TRUE(sut) << sut.error().text;
  ASSERT_TRUE(sut->left.port);
  EXPECT_FALSE(sut->right.port);
  const FlatPort& port = *sut->left.port;
  EXPECT_NEAR(port.normal.norm(), 1, 1e-15);
  EXPECT_LT((port.normal - Eigen::Vector3d(0.0131, -0.00446, 0.9999)).norm(), 1e-4);
  EXPECT_EQ(port.distance_m, 0.0253);
  EXPECT_EQ(port.thickness_m, 0.008);
  EXPECT_EQ(port.air_index, 1.0003);
  EXPECT_EQ(port.glass_index, 1.47);
  EXPECT_EQ(port.water_index, 1.34);
  const auto plain = parse_rig(kGood + kPort, "rig.toml");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->left.port->air_index, 1);
  EXPECT_EQ(plain->left.port->glass_index, 1.49);
  EXPECT_EQ(plain->left.port->water_index, 1.333);
}

TEST(RigFile, faults_of_a_port_are_told_with_their_lines) {
  EXPECT_EQ(error_of(kGood + "[port]\nthickness_m = 0.01\n"),
            "rig.toml:20: port: each camera has its own: write [left.port] and [right.port]");
  EXPECT_EQ(error_of(kGood + replaced(kPort, "distance_m = 0.0253\n", "")),
            "rig.toml:20: left.port.distance_m: is missing");
  EXPECT_EQ(error_of(kGood + replaced(kPort, "0.9999", "0.5")).substr(0, 57),
            "rig.toml:21: left.port.normal: is not a unit vector: its ");
  EXPECT_EQ(error_of(kGood + replaced(kPort, "0.9999", "-0.9999")),
            "rig.toml:21: left.port.normal: is more than 60 degrees off the camera's axis");
  EXPECT_EQ(error_of(kGood + replaced(kPort, "0.0253", "25.3")),
            "rig.toml:22: left.port.distance_m: 25.3 m is outside [0, 1]");
  EXPECT_EQ(error_of(kGood + kPort + "water_index = 0.9\n"),
            "rig.toml:24: left.port.water_index: 0.9 is outside [1, 2.5]");
}

TEST(RigFile, what_is_written_reads_back_as_it_was) {
  auto rig = parse_rig(kGood, "rig.toml").value();
  rig.left.distortion = Distortion::kBrown;
  rig.left.coefficients = {-0.28, 0.09, 0.001, -0.0007, 0.01};
  rig.left.time_offset = from_seconds(-0.004);
  rig.left.port =
      FlatPort{Eigen::Vector3d(0.02, -0.03, 1).normalized(), 0.031, 0.012, 1.0, 1.47, 1.34};
  rig.right.distortion = Distortion::kFisheye;
  rig.right.coefficients = {0.01, -0.02, 0.003, 0.0001, 0};
  rig.right_from_left.rotation = Eigen::AngleAxisd(0.02, Eigen::Vector3d(1, 2, -1).normalized());
  rig.body_from_hand = {Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.2, 0, 0.9}};
  const auto read = parse_rig(rig_text(rig), "rig.toml");
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->left.coefficients, rig.left.coefficients);
  EXPECT_EQ(read->left.time_offset, rig.left.time_offset);
  EXPECT_EQ(read->right.coefficients, rig.right.coefficients);
  EXPECT_EQ(read->left.fx, rig.left.fx);
  ASSERT_TRUE(read->left.port);
  EXPECT_LT((read->left.port->normal - rig.left.port->normal).norm(), 1e-15);
  EXPECT_EQ(read->left.port->distance_m, 0.031);
  EXPECT_EQ(read->left.port->thickness_m, 0.012);
  EXPECT_EQ(read->left.port->glass_index, 1.47);
  EXPECT_EQ(read->left.port->water_index, 1.34);
  EXPECT_FALSE(read->right.port);
  EXPECT_LT(read->right_from_left.rotation.angularDistance(rig.right_from_left.rotation), 1e-7);
  EXPECT_LT((read->hand_from_left.translation - rig.hand_from_left.translation).norm(), 1e-12);
  ASSERT_TRUE(read->body_from_hand);
  EXPECT_LT(read->body_from_hand->rotation.angularDistance(rig.body_from_hand->rotation), 1e-7);
}

TEST(RigFile, the_example_with_ports_loads) {
  const auto rig = load_rig("docs/examples/port-rig.toml");
  ASSERT_TRUE(rig) << rig.error().text;
  EXPECT_TRUE(rig->left.port && rig->right.port);
  EXPECT_TRUE(rig->body_from_hand);
}

TEST(RigFile, a_missing_file_is_told) {
  const auto rig = load_rig("no/such/rig.toml");
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().text, "no/such/rig.toml: cannot be opened: No such file or directory");
}

}  // namespace
}  // namespace gannet::config

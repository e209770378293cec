#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "platform/base/stage_timer.hpp"
#include "src/image_file/image_file.hpp"
#include "src/modeldb/model_file.hpp"
#include "src/tool/report_csv.hpp"
#include "src/tool/report_figures.hpp"
#include "src/tool/report_npy.hpp"
#include "src/tool/report_stereo.hpp"
#include "src/tool/subcommands.hpp"
#include "tests/support/temporary_folder.hpp"

namespace gannet::tool {
namespace {

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

const char* const kRig =
    "[left]\nwidth = 64\nheight = 48\nfx = 100.0\nfy = 100.0\ncx = 30.0\ncy = 25.0\n"
    "distortion = \"none\"\ncoefficients = []\n"
    "[right]\nwidth = 64\nheight = 48\nfx = 100.0\nfy = 100.0\ncx = 32.0\ncy = 25.0\n"
    "distortion = \"none\"\ncoefficients = []\n"
    "[right_from_left]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\ntranslation_m = [-0.2, 0, 0]\n";

StereoRig rig() {
  StereoRig made;
  made.left = {.width = 64, .height = 48, .fx = 100, .fy = 100, .cx = 30, .cy = 25};
  made.right = made.left;
  made.right.cx = 32;
  made.right_from_left.translation = {-0.2, 0, 0};
  return made;
}

// The disparities of a plane through (0, 0, depth) with this normal, by the rig's projection.
FloatMap disparity_of(double depth_m, const Eigen::Vector3d& normal) {
  FloatMap map = {64, 48, std::vector<float>(64 * 48)};
  const StereoRig r = rig();
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const Eigen::Vector3d ray = r.left.ray({u, v});
      const Eigen::Vector3d point = ray * (normal.z() * depth_m / normal.dot(ray));
      const auto in_right = r.right.project(r.right_from_left(point));
      map.values[static_cast<std::size_t>(v * 64 + u)] = static_cast<float>(u - in_right->x());
    }
  return map;
}

std::string npy_of(const FloatMap& map) {
  std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                     std::to_string(map.height) + ", " + std::to_string(map.width) + "), }";
  head.resize(118, ' ');
  std::string file = "\x93NUMPY";
  file += {'\x01', '\0', '\x76', '\0'};
  file += head;
  file.append(reinterpret_cast<const char*>(map.values.data()), map.values.size() * sizeof(float));
  return file;
}

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(CsvTable, gives_columns_and_leaves_the_rest_to_the_last) {
  const auto sut = CsvTable::parse("t.csv", "time_s,event\n0.5,goal 1,2,3\n2,arm\n");
  ASSERT_TRUE(sut) << sut.error().text;
  EXPECT_EQ(*sut->numbers("time_s"), (std::vector<double>{0.5, 2}));
  EXPECT_EQ(*sut->texts("event"), (std::vector<std::string>{"goal 1,2,3", "arm"}));
  EXPECT_FALSE(sut->numbers("z_m"));
}

TEST(CsvTable, names_the_line_that_is_wrong) {
  const auto ragged = CsvTable::parse("t.csv", "a,b\n1,2\n3\n");
  ASSERT_FALSE(ragged);
  EXPECT_NE(ragged.error().text.find("t.csv:3"), std::string::npos) << ragged.error().text;
  const auto word = CsvTable::parse("t.csv", "a,b\n1,2\n3,x\n")->numbers("b");
  ASSERT_FALSE(word);
  EXPECT_NE(word.error().text.find("t.csv:3"), std::string::npos) << word.error().text;
  EXPECT_FALSE(CsvTable::parse("t.csv", ""));
}

TEST(Npy, is_read_and_every_shorter_file_refused) {
  const std::string file = npy_of(disparity_of(2, {0, 0, 1}));
  const auto map = decode_npy(bytes_of(file), "d.npy");
  ASSERT_TRUE(map) << map.error().text;
  EXPECT_EQ(map->width, 64);
  EXPECT_EQ(map->height, 48);
  EXPECT_FLOAT_EQ(map->at(63, 47), 100 * 0.2F / 2 - 2);
  for (std::size_t length = 0; length < file.size(); length += length < 200 ? 1 : 97)
    EXPECT_FALSE(decode_npy(bytes_of(file).first(length), "d.npy")) << length;
}

TEST(Npy, other_types_and_shapes_are_refused) {
  const std::string file = npy_of(disparity_of(2, {0, 0, 1}));
  for (const auto& [from, to] : {std::pair{"<f4", "<f8"},
                                 {"<f4", ">f4"},
                                 {"False", "True "},
                                 {"(48, 64)", "(48, -4)"},
                                 {"(48, 64)", "(3072,) "},
                                 {"(48, 64)", "(99, 64)"}}) {
    std::string other = file;
    other.replace(other.find(from), std::strlen(from), to);
    EXPECT_FALSE(decode_npy(bytes_of(other), "d.npy")) << to;
  }
}

TEST(PlaneOf, finds_depth_and_normal_of_slanted_planes) {
  const vision::Rectangle r = {10, 8, 21, 15};
  const std::vector<Eigen::Vector3d> normals = {{0, 0, 1}, {0.3, -0.5, 0.8}, {-0.6, 0, 0.7}};
  for (const Eigen::Vector3d& normal : normals) {
    const Eigen::Vector3d unit = normal.normalized();
    const auto plane = plane_of(disparity_of(1.5, unit), r, rig());
    ASSERT_TRUE(plane) << plane.error().text;
    const Eigen::Vector3d ray = rig().left.ray({20, 15});  // the rectangle's centre
    EXPECT_NEAR(plane->depth_m, 1.5 * unit.z() / unit.dot(ray), 1e-5);
    EXPECT_NEAR(plane->normal.dot(unit), 1, 1e-8);
    EXPECT_LT(plane->residual_px, 1e-3);
  }
}

TEST(PlaneOf, refuses_what_tells_no_depth) {
  FloatMap map = disparity_of(1.5, {0, 0, 1});
  StereoRig turned = rig();
  turned.right_from_left.rotation = Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY());
  EXPECT_FALSE(plane_of(map, {10, 8, 21, 15}, turned));
  EXPECT_FALSE(plane_of(map, {60, 8, 21, 15}, rig()));
  for (int v = 8; v < 23; ++v)
    for (int u = 10; u < 22; ++u) map.values[static_cast<std::size_t>(v * 64 + u)] = INFINITY;
  EXPECT_FALSE(plane_of(map, {10, 8, 21, 15}, rig()));
  EXPECT_TRUE(plane_of(map, {10, 8, 40, 15}, rig()));
}

// A record of a run as gannet-world writes it, made small: from 0 to 4 s every 0.1 s; 100 mm off
// along x until 1 s, then ±2 mm.
class ReportTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(run_);
    write(run_ + "/rig.toml", kRig);
    write(run_ + "/events.csv", "time_s,event\n0.300000,target crab\n0.500000,arm\n");
    write_result("stepped", true);
    std::string trace = "time_s";
    for (const char* of : {"vehicle", "target"}) trace += pose_names(of);
    trace +=
        ",error_x_m,error_y_m,error_z_m,error_yaw_rad,in_view,estop,release,armed,throttle_1,"
        "supervisor,permit,frame,capture_s,track,found,fitness";
    for (const char* of : {"estimate", "truth"}) trace += pose_names(of);
    for (int k = 0; k <= 40; ++k) {
      const double error = k < 10 ? 0.1 : k % 2 == 0 ? 0.002 : -0.002;
      const std::string x = std::to_string(error);
      trace += "\n" + std::to_string(0.1 * k) + ",0,0,0,1,0,0,0," + x + ",0,0.5,1,0,0,0," + x +
               ",0,0,0.01,1,0,0,1,0.25,servoing,full," + std::to_string(k) + "," +
               std::to_string(0.1 * k - 0.04) + ",locked," + (k < 4 ? "0" : "1") +
               ",0.9,0.061,0,0.5,1,0,0,0,0.060,0,0.5,1,0,0,0";
    }
    write(run_ + "/trace.csv", trace + "\n");
  }
  static std::string pose_names(const std::string& of) {
    std::string names;
    for (const char* part : {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"})
      names += "," + of + "_" + part;
    return names;
  }
  void write_result(const std::string& clock, bool passed) {
    write(run_ + "/result.json",
          "{\"scenario\": \"small\", \"description\": \"hold\", \"clock\": \"" + clock +
              "\", \"duration_s\": 4, \"seed\": 1, \"host_s\": 2, \"passed\": " +
              (passed ? "true" : "false") +
              ", \"checks\": [{\"check\": \"settle_s < 6\", \"found\": \"0.5\", \"passed\": " +
              (passed ? "true" : "false") +
              "}], \"measures\": {\"settle_s\": 0.5}, \"daemon\": {\"latencies\": "
              "{\"frame_to_pose\": {\"p50_us\": 1048.576, \"p99_us\": 2097.152, \"buckets\": "
              "[[1048.576, 3], [2097.152, 1]]}}, \"drops\": {\"vision_skipped\": 7}}}");
  }
  int report(const std::vector<std::string>& more = {}) {
    std::vector<std::string> args = {"report", run_, "-o", page_};
    args.insert(args.end(), more.begin(), more.end());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int code = run_gannet(args);
    said_ = ::testing::internal::GetCapturedStdout();
    told_ = ::testing::internal::GetCapturedStderr();
    return code;
  }
  const test::TemporaryFolder folder_;
  const std::string run_ = folder_ / "run";
  const std::string page_ = folder_ / "report.html";
  std::string said_, told_;
};

TEST_F(ReportTest, reads_what_a_run_left) {
  const auto run = read_run(run_);
  ASSERT_TRUE(run) << run.error().text;
  EXPECT_TRUE(run->stepped);
  EXPECT_EQ(run->time_s.size(), 41u);
  EXPECT_EQ(run->frames.size(), 40u);  // frame 0: nothing heard yet
  EXPECT_NEAR(run->settled_s(), 1.0, 1e-12);
  EXPECT_NEAR(run->yaw_deg[0], 0.573, 1e-3);
  EXPECT_NEAR(run->frames[0].estimate.translation.x() - run->frames[0].truth.translation.x(), 1e-3,
              1e-12);
  // The vehicle stands at the origin, so the held point is the goal.
  EXPECT_NEAR(run->target_mm[0][0], 100, 1e-9);
  EXPECT_NEAR(run->held_mm[0][0], 0, 1e-9);
  EXPECT_NEAR(run->held_mm[2][0], 500, 1e-9);
}

TEST_F(ReportTest, figures_are_those_of_the_record) {
  ASSERT_EQ(report(), 0) << told_;
  const auto has = [&](const std::string& words) { return said_.find(words) != std::string::npos; };
  EXPECT_TRUE(has("100 / 0.6"));           // start
  EXPECT_TRUE(has("2.0 / 0.0 / 0.0"));     // rms while held
  EXPECT_TRUE(has("1.00 / 0.00 / 0.00"));  // recognition minus truth
  EXPECT_TRUE(has("0.50"));                // settling time
  EXPECT_TRUE(has("1.0 / – / 2.1 / –"));   // frame → pose
  const std::string html = text_of(page_);
  EXPECT_NE(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("vision_skipped"), std::string::npos);
  EXPECT_EQ(html.find("http"), html.find("http://www.w3.org"));  // nothing is fetched
}

TEST_F(ReportTest, samples_of_a_histogram_lie_in_their_buckets) {
  const auto run = read_run(run_);
  ASSERT_TRUE(run);
  const auto samples = latency_samples_ms(*run, "frame_to_pose");
  ASSERT_EQ(samples.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto ns = static_cast<std::int64_t>(samples[i] * 1e6);
    const double upper_us =
        static_cast<double>(LogHistogram::upper_edge(LogHistogram::bucket_of(ns))) / 1000;
    EXPECT_NEAR(upper_us, i < 3 ? 1048.576 : 2097.152, 1e-9);
  }
}

TEST_F(ReportTest, a_stepped_failure_decides_and_a_live_one_does_not) {
  write_result("stepped", false);
  EXPECT_EQ(report(), 1);
  EXPECT_TRUE(std::filesystem::exists(page_));
  write_result("live", false);
  EXPECT_EQ(report(), 0);
}

TEST_F(ReportTest, wrong_records_are_refused_and_no_page_is_written) {
  const std::pair<const char*, const char*> faults[] = {
      {"result.json", "{\"clock\": "},       {"result.json", "{\"clock\": \"slow\"}"},
      {"trace.csv", "time_s\n0\n0.1\n"},     {"trace.csv", ""},
      {"events.csv", "time_s,event\nx,y\n"}, {"rig.toml", "[left]\nwidth = 0\n"}};
  for (const auto& [name, text] : faults) {
    SetUp();
    write(run_ + "/" + name, text);
    EXPECT_EQ(report(), 2) << name;
    EXPECT_NE(told_.find(name), std::string::npos) << told_;
    EXPECT_FALSE(std::filesystem::exists(page_));
  }
  std::filesystem::remove_all(run_);
  EXPECT_EQ(report(), 2);
}

TEST_F(ReportTest, a_picture_needs_kept_frames) {
  EXPECT_EQ(report({"--picture", folder_ / "p.jpg"}), 2);
  EXPECT_NE(told_.find("--keep-every"), std::string::npos) << told_;
}

TEST_F(ReportTest, kept_frames_show_what_was_recognised) {
  vision::PhotoPatch patch;
  patch.name = "crab";
  patch.width = patch.height = 16;
  patch.yuv.assign(16 * 16 * 3, 128);
  patch.mask.assign(16 * 16, 1);
  patch.distance_m = 0.4;
  patch.fx = patch.fy = 100;
  patch.centre_px = {7.5, 7.5};
  patch.size_m = {0.064, 0.064};
  ASSERT_TRUE(modeldb::save_model(run_ + "/crab.gannet", patch));
  const hal::Image image(64, 48, hal::PixelFormat::kRgb24);
  for (const char* eye : {"/frames/left/", "/frames/right/"}) {
    std::filesystem::create_directories(run_ + eye);
    for (const char* name : {"01.png", "02.png", "03.png"})
      ASSERT_TRUE(image_file::write_png(run_ + eye + name, image.view()));
  }
  // In the first the target was not found yet.
  write(run_ + "/frames/times.csv", "frame,time_s\n01,0.26\n02,0.66\n03,3.96\n");
  ASSERT_EQ(report({"--picture", folder_ / "p.jpg"}), 0) << told_;
  const std::string html = text_of(page_);
  EXPECT_EQ(html.find("0.3 s: "), std::string::npos);
  EXPECT_NE(html.find("0.7 s: 100.0 mm and 0.6° from the goal"), std::string::npos);
  EXPECT_NE(html.find("4.0 s: 2.0 mm"), std::string::npos);
  const auto picture = image_file::read_image(folder_ / "p.jpg");
  ASSERT_TRUE(picture) << picture.error().text;
  EXPECT_EQ(picture->width(), 2 * 64 + 4);
  // Black frames: what is bright was drawn, at the target in either of them.
  const hal::Image drawn = hal::to_yuv444(picture->view());
  for (const int first : {0, 64 + 4}) {
    const auto* row = drawn.row(0, 25);  // through the target's middle: its z and x axes
    EXPECT_GT(*std::max_element(row + first + 36, row + first + 48), 60);
  }
  std::filesystem::remove(run_ + "/crab.gannet");
  EXPECT_EQ(report(), 2);
  EXPECT_NE(told_.find("crab.gannet"), std::string::npos) << told_;
}

class StereoTest : public ReportTest {
 protected:
  void SetUp() override {
    ReportTest::SetUp();
    std::filesystem::create_directories(pair_);
    write(pair_ + "/rig.toml", kRig);
    write(pair_ + "/disparity.npy", npy_of(disparity_of(2, {0, 0, 1})));
    write(pair_ + "/rectangles.csv", "name,x,y,width,height\nbox,10,8,21,15\n");
    const hal::Image image(64, 48, hal::PixelFormat::kRgb24);
    for (const char* eye : {"/left.png", "/right.png"})
      ASSERT_TRUE(image_file::write_png(pair_ + eye, image.view()));
    answer(2);
  }
  void answer(double depth_m) {
    write(pair_ + "/box.json",
          "{\"found\": true, \"position_m\": [-0.2, -0.2, " + std::to_string(depth_m) +
              "], \"quaternion\": [1, 0, 0, 0], \"sigma_m\": [0, 0, 0.01], \"fitness\": 0.9, "
              "\"time_ms\": 50}");
  }
  const std::string pair_ = folder_ / "pair";
};

TEST_F(StereoTest, sets_found_beside_true_depth) {
  answer(2.05);
  ASSERT_EQ(report({"--stereo", pair_}), 0) << told_;
  EXPECT_NE(said_.find("2000"), std::string::npos) << said_;
  EXPECT_NE(said_.find("2.50"), std::string::npos) << said_;  // percent
  EXPECT_NE(text_of(page_).find("image/jpeg"), std::string::npos);
}

TEST_F(StereoTest, a_depth_far_off_or_not_found_fails) {
  answer(2.2);
  EXPECT_EQ(report({"--stereo", pair_}), 1);
  write(pair_ + "/box.json", "{\"found\": false, \"fitness\": 0.1, \"position_m\": null}");
  EXPECT_EQ(report({"--stereo", pair_}), 1);
  EXPECT_NE(said_.find("not found"), std::string::npos) << said_;
}

TEST_F(StereoTest, wrong_folders_are_refused) {
  const std::pair<const char*, const char*> faults[] = {
      {"disparity.npy", "no array"},
      {"rectangles.csv", "name,x,y,width,height\nbox,60,8,21,15\n"},
      {"box.json", "[]"},
      {"left.png", "no picture"},
      {"rig.toml", "[left]\n"},
      {"rectangles.csv", "name,x,y,width\nbox,1,2,3\n"}};
  for (const auto& [name, text] : faults) {
    SetUp();
    write(pair_ + "/" + name, text);
    EXPECT_EQ(report({"--stereo", pair_}), 2) << name;
    EXPECT_NE(told_.find(name), std::string::npos) << told_;
  }
}

}  // namespace
}  // namespace gannet::tool

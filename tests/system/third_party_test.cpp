// Recognition on pictures that nobody here made, where they are at hand: third-party creatures
// rendered with truth, and Middlebury pairs with known depth. The folder is $GANNET_DATA or
// ../shared/data; without it these tests skip. All conditions are printed, also with the photo of
// one condition on the frames of the others; what must hold is asserted.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "src/config/rig_file.hpp"
#include "src/image_file/image_file.hpp"
#include "src/track/recogniser.hpp"
#include "src/track/target_tracker.hpp"
#include "tests/support/heap_calls.hpp"

namespace gannet {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  const char* named = std::getenv("GANNET_DATA");
  return named != nullptr ? named : "../shared/data";
}

hal::Image image_of(const fs::path& path) {
  auto image = image_file::read_image(path.string());
  EXPECT_TRUE(image) << image.error().text;
  return image ? std::move(*image) : hal::Image{};
}

nlohmann::json truth_of(const fs::path& folder) {
  return nlohmann::json::parse(std::ifstream(folder / "truth.json"));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

// The papers' allowance: a third of the target's size in x and y, 50 mm in z.
struct Tally {
  int frames = 0;
  int good = 0;  // found, within the allowance
  int false_finds = 0;
  std::vector<double> xy_mm, z_mm, angle_deg;

  void add(bool found, const Transform<LeftCamera, Target>& got, const nlohmann::json& truth,
           const nlohmann::json& size) {
    ++frames;
    if (!found) return;
    const auto& p = truth["position_m"];
    const auto& q = truth["quaternion"];
    const Eigen::Vector3d error = got.translation - Eigen::Vector3d(p[0], p[1], p[2]);
    const bool within = std::abs(error.x()) <= static_cast<double>(size[0]) / 3 &&
                        std::abs(error.y()) <= static_cast<double>(size[1]) / 3 &&
                        std::abs(error.z()) <= 0.05;
    (within ? good : false_finds) += 1;
    if (!within) return;
    xy_mm.push_back(1e3 * error.head<2>().norm());
    z_mm.push_back(1e3 * std::abs(error.z()));
    angle_deg.push_back(57.29578 *
                        got.rotation.angularDistance(Eigen::Quaterniond(q[0], q[1], q[2], q[3])));
  }
  void print(const std::string& what) const {
    std::printf("%-58s %3d of %3d, wrong %d, medians xy %.2f mm, z %.2f mm, angle %.1f deg\n",
                what.c_str(), good, frames, false_finds, quantile(xy_mm, 0.5), quantile(z_mm, 0.5),
                quantile(angle_deg, 0.5));
  }
};

class ThirdParty : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data_folder() / "rendered")) GTEST_SKIP() << "no third-party data here";
    if (!test::kCountsHeap) GTEST_SKIP() << "too slow under a sanitizer";
  }

  static vision::PatchModel model_of(const fs::path& set, const std::string& condition,
                                     const StereoRig& rig) {
    const hal::Image photo = image_of(set / condition / "photo_400mm.jpg");
    const hal::Image background = image_of(set / condition / "background_left.jpg");
    const hal::Image mask = image_of(set / "photo_400mm_mask.png");
    const hal::ImageView background_view = background.view();
    const hal::ImageView mask_view = mask.view();
    vision::PhotoInput input;
    input.target = photo.view();
    input.background = &background_view;
    input.mask = &mask_view;
    input.distance_m = 0.4;
    input.name = set.filename().string();
    const auto patch = vision::cut_out(input, rig.left);
    EXPECT_TRUE(patch) << patch.error().text;
    return vision::make_patch_model(*patch, {}).value();
  }

  static fs::path frame_file(const fs::path& folder, int index) {
    std::array<char, 16> name;
    std::snprintf(name.data(), name.size(), "%04d.jpg", index);
    return folder / name.data();
  }
};

TEST_F(ThirdParty, creatures_are_located_from_nothing_in_single_frames) {
  Serial serial;
  int empty_frames = 0;
  int false_finds = 0;  // in frames without the target, but with other creatures
  for (const char* name : {"dev_goldfish", "dev_tuna"}) {
    const fs::path set = data_folder() / "rendered" / name;
    const StereoRig rig = config::load_rig((set / "rig.toml").string()).value();
    const nlohmann::json truth = truth_of(set);
    auto sut = track::Recogniser::create({}, rig, track::TargetKind::kModel).value();
    vision::PreparedFrame frame(rig.left.width, rig.left.height, sut->needs());
    const std::array<const char*, 4> conditions = {"air_bright", "pool_bright", "dark5lux",
                                                   "turbid"};
    for (const std::string photo : conditions) {
      const vision::PatchModel model = model_of(set, photo, rig);
      for (const std::string condition : conditions) {
        Tally tally;
        for (const auto& seen : truth["frames"]) {
          const int index = seen["index"];
          const hal::Image left = image_of(frame_file(set / condition / "left", index));
          const hal::Image right = image_of(frame_file(set / condition / "right", index));
          ASSERT_TRUE(frame.prepare(left.view(), right.view()));
          ASSERT_TRUE(sut->set_model(model));
          const track::Recognition got = sut->recognise(frame, nullptr, {}, serial);
          tally.add(got.found, got.left_from_target, seen, truth["size_m"]);
        }
        tally.print(std::string(name) + ", " + condition + ", photo " + photo);
        const bool bright = condition == "air_bright" || condition == "pool_bright";
        if (bright && photo == condition) {
          EXPECT_GE(tally.good, 0.95 * tally.frames) << name << " " << condition;
        }
        const hal::Image left = image_of(set / condition / "background_left.jpg");
        const hal::Image right = image_of(set / condition / "background_right.jpg");
        ASSERT_TRUE(frame.prepare(left.view(), right.view()));
        const bool false_find = sut->recognise(frame, nullptr, {}, serial).found;
        ++empty_frames;
        false_finds += false_find;
        if (photo == condition) {
          EXPECT_FALSE(false_find) << name << " " << condition;
        }
      }
    }
  }
  std::printf("found where it is not: %d of %d frames\n", false_finds, empty_frames);
}

TEST_F(ThirdParty, a_swimming_creature_is_tracked_from_the_first_frame) {
  const fs::path set = data_folder() / "rendered" / "dev_sine_goldfish";
  const StereoRig rig = config::load_rig((set / "rig.toml").string()).value();
  const nlohmann::json truth = truth_of(set);
  Serial serial;
  for (const std::string condition : {"pool_bright", "dark5lux"}) {
    auto sut = track::TargetTracker::create({}, rig, {model_of(set, condition, rig)}).value();
    ASSERT_TRUE(sut->choose_model(0, 1));
    const auto& frames = truth["frames"];
    std::vector<hal::Image> left, right;
    for (const auto& seen : frames) {
      left.push_back(image_of(frame_file(set / condition / "left", seen["index"])));
      right.push_back(image_of(frame_file(set / condition / "right", seen["index"])));
    }
    // There and back again, so that there is time to learn that the creature is not flat.
    constexpr int kRounds = 9;
    std::uint64_t number = 0;
    std::array<Tally, kRounds> tallies;
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t k = 0; k < left.size(); ++k) {
        const std::size_t at = round % 2 == 0 ? k : left.size() - 1 - k;
        const auto time = time_from_ns(static_cast<std::int64_t>(number) * 33'333'333);
        const PoseEstimate got =
            sut->process(left[at].view(), right[at].view(), time, ++number, {}, serial);
        if (number == 1) {
          EXPECT_TRUE(got.found) << condition << ": not in the first frame";
        }
        tallies[static_cast<std::size_t>(round)].add(got.found, got.left_from_target, frames[at],
                                                     truth["size_m"]);
      }
    }
    tallies.front().print("dev_sine_goldfish, " + condition + ", tracked");
    tallies.back().print("dev_sine_goldfish, " + condition + ", relief learned");
    for (const Tally& tally : tallies) EXPECT_GE(tally.good, 0.95 * tally.frames) << condition;
    EXPECT_LT(quantile(tallies.back().angle_deg, 0.5), quantile(tallies.front().angle_deg, 0.5));
  }
}

TEST_F(ThirdParty, planes_of_real_pairs_are_found_at_their_depth) {
  std::vector<double> depth_percent, normal_deg;
  int found = 0;
  Serial serial;
  for (const std::string name : {"motorcycle", "aloe", "cones", "wood2"}) {
    const fs::path set = data_folder() / "real" / name;
    const StereoRig rig = config::load_rig((set / "rig.toml").string()).value();
    const nlohmann::json truth = truth_of(set);
    const std::string kind = fs::exists(set / "left.png") ? ".png" : ".jpg";
    const hal::Image left = image_of(set / ("left" + kind));
    const hal::Image right = image_of(set / ("right" + kind));
    track::TrackConfig config;
    config.tilt_deg = 65;
    config.z_min_m = 1e9;
    config.z_max_m = 0;
    for (const auto& patch : truth["patches"]) {
      config.z_min_m = std::min(config.z_min_m, 0.6 * static_cast<double>(patch["z_m"]));
      config.z_max_m = std::max(config.z_max_m, 1.6 * static_cast<double>(patch["z_m"]));
    }
    auto sut = track::Recogniser::create(config, rig, track::TargetKind::kRectangle).value();
    vision::PreparedFrame frame(rig.left.width, rig.left.height, sut->needs());
    ASSERT_TRUE(frame.prepare(left.view(), right.view()));
    std::vector<double> own_percent, own_deg;
    for (const auto& patch : truth["patches"]) {
      const auto& n = patch["normal_left_camera"];
      const Eigen::Vector3d normal(n[0], n[1], n[2]);
      if (std::abs(normal.z()) < 0.5) continue;  // slanted over 60 degrees
      const auto& r = patch["rect"];
      ASSERT_TRUE(sut->set_rectangle({r[0], r[1], r[2], r[3]}, frame));
      const track::Recognition got = sut->recognise(frame, nullptr, {}, serial);
      found += got.found;
      const double z = patch["z_m"];
      own_percent.push_back(100 * std::abs(got.left_from_target.translation.z() / z - 1));
      const Eigen::Vector3d seen = got.left_from_target.rotation * Eigen::Vector3d::UnitZ();
      own_deg.push_back(57.29578 * std::acos(std::min(1.0, std::abs(seen.dot(normal)))));
    }
    std::printf(
        "%-12s %zu rectangles: depth median %.2f %%, 90th percentile %.2f %%; normals %.1f deg\n",
        name.c_str(), own_percent.size(), quantile(own_percent, 0.5), quantile(own_percent, 0.9),
        quantile(own_deg, 0.5));
    depth_percent.insert(depth_percent.end(), own_percent.begin(), own_percent.end());
    normal_deg.insert(normal_deg.end(), own_deg.begin(), own_deg.end());
  }
  std::printf(
      "all %zu rectangles, found %d: depth median %.2f %%, 90th percentile %.2f %%; "
      "normals %.1f deg\n",
      depth_percent.size(), found, quantile(depth_percent, 0.5), quantile(depth_percent, 0.9),
      quantile(normal_deg, 0.5));
  EXPECT_LT(quantile(depth_percent, 0.5), 0.5);
  EXPECT_LT(quantile(depth_percent, 0.9), 4);
  EXPECT_LT(quantile(normal_deg, 0.5), 6);
}

}  // namespace
}  // namespace gannet

#include "src/vision/patch_model.hpp"

#include <gtest/gtest.h>

#include "src/vision/point_set.hpp"
#include "tests/support/flat_scene.hpp"

namespace gannet::vision {
namespace {

using test::pose_at;

class Photo : public testing::Test {
 protected:
  Photo() {
    background_view = empty.view();
    input.target = photo.view();
    input.background = &background_view;
    input.distance_m = 0.4;
  }
  test::FlatScene scene;
  Transform<LeftCamera, Target> square = pose_at(0, 0, 0.4);
  test::Picture photo = scene.see(true, &square, 1);
  test::Picture empty = scene.see(true, nullptr, 2);
  hal::ImageView background_view;
  PhotoInput input;
};

TEST_F(Photo, is_cut_out_by_its_background) {
  const auto patch = cut_out(input, scene.rig.left);
  ASSERT_TRUE(patch) << patch.error().text;
  EXPECT_NEAR(patch->size_m.x(), scene.size_m.x(), 0.008);
  EXPECT_NEAR(patch->size_m.y(), scene.size_m.y(), 0.008);
}

TEST_F(Photo, is_cut_out_by_a_mask_to_the_pixel) {
  test::Picture mask = photo;
  for (int row = 0; row < mask.height; ++row) {
    for (int col = 0; col < mask.width; ++col) {
      const double x = (col - 159.5) * 0.4 / 320, y = (row - 119.5) * 0.4 / 320;
      mask.y[static_cast<std::size_t>(row * mask.width + col)] = scene.covers(x, y) ? 255 : 0;
    }
  }
  const hal::ImageView mask_view = mask.view();
  input.mask = &mask_view;
  input.background = nullptr;
  const auto patch = cut_out(input, scene.rig.left);
  ASSERT_TRUE(patch) << patch.error().text;
  EXPECT_NEAR(patch->size_m.x(), scene.size_m.x(), 2 * 0.4 / 320);
  EXPECT_NEAR(patch->size_m.y(), scene.size_m.y(), 2 * 0.4 / 320);
}

TEST_F(Photo, has_its_origin_where_one_is_given) {
  const auto before = cut_out(input, scene.rig.left);
  const Intrinsics& camera = scene.rig.left;
  input.origin_px = Eigen::Vector2d(camera.cx + 8, camera.cy - 4);
  const auto after = cut_out(input, camera);
  ASSERT_TRUE(before && after);
  const Eigen::Vector2d moved = after->centre_px - before->centre_px;
  // The silhouette's own middle is known to about a pixel.
  EXPECT_LT((moved - Eigen::Vector2d(8, -4)).norm(), 2) << moved.transpose();
  EXPECT_EQ(before->size_m, after->size_m);
  input.origin_px = Eigen::Vector2d(0, 0);
  EXPECT_FALSE(cut_out(input, camera));
}

TEST_F(Photo, that_equals_its_background_is_refused) {
  input.background = &input.target;
  const auto patch = cut_out(input, scene.rig.left);
  ASSERT_FALSE(patch);
  EXPECT_NE(patch.error().text.find("equals"), std::string::npos) << patch.error().text;
}

TEST_F(Photo, without_a_target_is_refused) {
  const test::Picture other = scene.see(true, nullptr, 3);
  input.target = other.view();
  const auto patch = cut_out(input, scene.rig.left);
  ASSERT_FALSE(patch);
  EXPECT_NE(patch.error().text.find("empty"), std::string::npos) << patch.error().text;
}

TEST_F(Photo, at_no_distance_or_of_another_size_is_refused) {
  input.distance_m = 0;
  EXPECT_FALSE(cut_out(input, scene.rig.left));
  input.distance_m = 0.4;
  Intrinsics other = scene.rig.left;
  other.width = 640;
  EXPECT_FALSE(cut_out(input, other));
}

TEST_F(Photo, gives_about_as_many_points_as_wanted_around_the_origin) {
  const auto patch = cut_out(input, scene.rig.left);
  for (const int wanted : {100, 400, 1000}) {
    BuildOptions options;
    options.inside_points = wanted;
    const auto model = make_patch_model(*patch, options);
    ASSERT_TRUE(model) << model.error().text;
    EXPECT_NEAR(model->inside_count, wanted, 0.06 * wanted + 5);
    EXPECT_GT(static_cast<int>(model->points.size()), model->inside_count);
    double x = 0;
    for (int i = 0; i < model->inside_count; ++i) {
      x += static_cast<double>(model->points[static_cast<std::size_t>(i)].x_m);
    }
    EXPECT_NEAR(x / model->inside_count, 0, 0.002);
  }
}

TEST_F(Photo, has_the_texture_where_its_points_say) {
  const auto model = make_patch_model(*cut_out(input, scene.rig.left), {});
  ASSERT_TRUE(model);
  double worst = 0;
  for (int i = 0; i < model->inside_count; ++i) {
    const ModelPoint& p = model->points[static_cast<std::size_t>(i)];
    const double x = static_cast<double>(p.x_m), y = static_cast<double>(p.y_m);
    if (!scene.covers(1.15 * x, 1.15 * y)) continue;  // the rim is mixed with the background
    worst =
        std::max(worst, std::abs(120 + scene.target.at(0, x, y) - static_cast<double>(p.colour.y)));
  }
  EXPECT_LT(worst, 6);  // grey levels: noise and half a pixel's slope
}

TEST(Coarsen, keeps_the_mean_colour_and_thins_by_the_square_of_the_factor) {
  std::vector<ModelPoint> points, coarse;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      points.push_back({0.01f * (static_cast<float>(x) + 0.5f),
                        0.01f * (static_cast<float>(y) + 0.5f),
                        true,
                        {static_cast<float>(x + y), 128, 128}});
    }
  }
  coarsen(points, 0.01, 4, coarse);
  EXPECT_EQ(coarse.size(), points.size() / 16);
  double mean = 0;
  for (const ModelPoint& p : coarse) mean += static_cast<double>(p.colour.y) / 100;
  EXPECT_NEAR(mean, 39, 0.01);
}

}  // namespace
}  // namespace gannet::vision

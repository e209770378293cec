#include "src/tool/preview.hpp"

#include <gtest/gtest.h>

namespace gannet::tool {
namespace {

StereoRig rig() {
  StereoRig rig;
  rig.left.width = 64;
  rig.left.height = 48;
  rig.left.fx = rig.left.fy = 64;
  rig.left.cx = 31.5;
  rig.left.cy = 23.5;
  rig.right = rig.left;
  rig.right_from_left.translation = {-0.1, 0, 0};
  return rig;
}

vision::PhotoPatch block() {  // 4 × 2 pixels of a 10 × 8 crop
  vision::PhotoPatch patch;
  patch.width = 10;
  patch.height = 8;
  patch.yuv.assign(240, 128);
  patch.mask.assign(80, 0);
  for (int y = 3; y < 5; ++y)
    for (int x = 3; x < 7; ++x) patch.mask[static_cast<std::size_t>(y * 10 + x)] = 255;
  patch.distance_m = 0.5;
  patch.fx = patch.fy = 100;
  patch.centre_px = {4.5, 3.5};
  return patch;
}

TEST(Outline, of_a_mask_is_its_border_in_metres) {
  const auto sut = outline_of(block());
  EXPECT_EQ(sut.size(), 12u);  // 2 · (4 + 2) pixel edges
  double length = 0;
  for (const Segment& s : sut) {
    length += (s.to - s.from).norm();
    EXPECT_LE(std::abs(s.from.x()), 0.010 + 1e-12);  // two pixels of 5 mm either side
    EXPECT_LE(std::abs(s.from.y()), 0.005 + 1e-12);
  }
  EXPECT_NEAR(length, 12 * 0.005, 1e-12);
}

TEST(Outline, of_a_rectangle_projects_back_to_it) {
  const vision::Rectangle r = {10, 8, 20, 12};
  const Transform<LeftCamera, Target> pose{quaternion_from_rpy(0.3, -0.4, 0), {-0.06, -0.05, 0.5}};
  for (const Segment& s : outline_of(r, rig().left, pose)) {
    const auto pixel = rig().left.project(pose({s.from.x(), s.from.y(), 0}));
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(std::abs(pixel->x() - 19.5), 10, 1e-9);
    EXPECT_NEAR(std::abs(pixel->y() - 13.5), 6, 1e-9);
  }
}

// Pixels of a colour that only the outline has.
int magenta(const hal::Image& picture, int first_column, int last_column) {
  int count = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = first_column; x <= last_column; ++x) {
      const std::uint8_t* p = picture.row(0, y) + 3 * x;
      count += p[0] > 150 && p[1] < 100 && p[2] > 150;
    }
  return count;
}

TEST(Overlay, draws_the_outline_into_both_images_and_never_from_one_into_the_other) {
  const hal::Image black(64, 48, hal::PixelFormat::kRgb24);
  const auto outline = outline_of(block());
  const int second = 64 + 4;
  Transform<LeftCamera, Target> pose;
  pose.translation = {0.02, 0, 0.2};
  hal::Image picture = draw_overlay(black, black, rig(), pose, outline, 0.005);
  EXPECT_GT(magenta(picture, 0, 63), 10);
  EXPECT_GT(magenta(picture, second, second + 63), 10);
  pose.translation = {0.13, 0, 0.2};  // right of the left image, inside the right one
  picture = draw_overlay(black, black, rig(), pose, outline, 0.005);
  EXPECT_EQ(magenta(picture, 0, 63), 0);
  EXPECT_GT(magenta(picture, second, second + 63), 10);
}

}  // namespace
}  // namespace gannet::tool

#include "src/image_file/drawing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "src/image_file/font.hpp"

namespace gannet::image_file {
namespace {

class Drawing : public ::testing::Test {
 protected:
  // Sum of the red channel, in pixels of full white.
  double drawn() const {
    double sum = 0;
    for (int y = 0; y < image_.height(); ++y)
      for (int x = 0; x < image_.width(); ++x) sum += red(x, y);
    return sum / 255;
  }
  int red(int x, int y) const { return image_.row(0, y)[3 * x]; }

  hal::Image image_{60, 50, hal::PixelFormat::kRgb24};
  Canvas sut_{image_};
};

TEST_F(Drawing, a_line_covers_its_length_times_its_width) {
  sut_.line({10, 10}, {40, 30}, colours::kWhite, 3);
  const double length = std::hypot(30, 20);
  EXPECT_NEAR(drawn(), length * 3 + std::numbers::pi * 1.5 * 1.5, 3);
  EXPECT_EQ(red(25, 20), 255);
  EXPECT_EQ(red(25, 26), 0);
}

TEST_F(Drawing, an_axis_parallel_line_of_one_pixel_fills_exactly_its_row) {
  sut_.line({10, 20}, {40, 20}, colours::kWhite, 1);
  EXPECT_EQ(red(25, 20), 255);
  EXPECT_EQ(red(25, 19), 0);
  EXPECT_EQ(red(25, 21), 0);
  EXPECT_EQ(red(8, 20), 0);
}

TEST_F(Drawing, a_polygon_covers_its_area_and_leaves_its_hole) {
  const std::vector<Point> square = {{9.5, 9.5}, {29.5, 9.5}, {29.5, 29.5}, {9.5, 29.5}};
  sut_.polygon(square, colours::kWhite);
  EXPECT_DOUBLE_EQ(drawn(), 400);
  sut_.fill(colours::kBlack);
  const std::vector<Point> triangle = {{10, 10}, {50, 15}, {20, 40}};
  sut_.polygon(triangle, colours::kWhite);
  EXPECT_NEAR(drawn(), 0.5 * (40 * 30 - 10 * 5), 3);
  sut_.fill(colours::kBlack);
  // A square walked around twice, the second time smaller: even-odd leaves the inner one out.
  const std::vector<Point> ring = {{0.5, 0.5},   {30.5, 0.5},  {30.5, 30.5}, {0.5, 30.5},
                                   {0.5, 0.5},   {10.5, 10.5}, {10.5, 20.5}, {20.5, 20.5},
                                   {20.5, 10.5}, {10.5, 10.5}};
  sut_.polygon(ring, colours::kWhite);
  EXPECT_NEAR(drawn(), 900 - 100, 1);
}

TEST_F(Drawing, circles_and_discs_have_their_length_and_area) {
  sut_.circle({30, 25}, 15, colours::kWhite, 2);
  EXPECT_NEAR(drawn(), 2 * std::numbers::pi * 15 * 2, 4);
  sut_.fill(colours::kBlack);
  sut_.disc({30, 25}, 15, colours::kWhite);
  EXPECT_NEAR(drawn(), std::numbers::pi * 15 * 15, 4);
}

TEST_F(Drawing, what_lies_outside_or_is_not_finite_draws_nothing_and_harms_nothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
  sut_.line({nan, 0}, {10, 10}, colours::kWhite);
  sut_.line({-100, -100}, {-50, 400}, colours::kWhite, 5);
  sut_.circle({nan, 3}, 5, colours::kWhite);
  sut_.polygon(std::vector<Point>{{0, 0}, {nan, 3}, {5, 5}}, colours::kWhite);
  sut_.polygon(std::vector<Point>{{100, 0}, {200, 3}, {150, 500}}, colours::kWhite);
  sut_.text(-100, -100, "outside", colours::kWhite);
  sut_.text(59, 49, " ", colours::kWhite, 4);
  sut_.blit(image_.view(), 60, 0);
  EXPECT_EQ(drawn(), 0);
  sut_.line({-huge, 20}, {huge, 20}, colours::kWhite, 1);
  sut_.disc({1e9, 1e9}, 5, colours::kWhite);
  sut_.text(57, 47, "partly", colours::kWhite, 2);
}

TEST_F(Drawing, opacity_mixes_with_what_is_there) {
  sut_.fill({100, 100, 100});
  sut_.polygon(std::vector<Point>{{0.5, 0.5}, {20.5, 0.5}, {20.5, 20.5}, {0.5, 20.5}},
               {200, 200, 200}, 0.25);
  EXPECT_EQ(red(10, 10), 125);
  EXPECT_EQ(red(30, 30), 100);
}

TEST_F(Drawing, text_draws_its_letters_dots_at_each_scale) {
  sut_.text(3, 4, "1.", colours::kWhite);
  EXPECT_DOUBLE_EQ(drawn(), 13 + 4);
  EXPECT_EQ(red(3 + 2, 4), 255);          // the top of the 1
  EXPECT_EQ(red(3 + 6 + 1, 4 + 6), 255);  // the dot
  sut_.fill(colours::kBlack);
  sut_.text(3, 4, "1\n.", colours::kWhite, 2);
  EXPECT_DOUBLE_EQ(drawn(), 4 * (13 + 4));
  EXPECT_EQ(text_size("20°\nx", 2).width, 3 * 12);
  EXPECT_EQ(text_size("20°\nx", 2).height, 2 * 20);
}

TEST(Font, each_glyph_has_whole_rows_and_is_unlike_the_others) {
  std::vector<std::vector<bool>> seen;
  for (char32_t letter = U'!'; letter <= U'~'; ++letter) {
    std::vector<bool> dots;
    for (int row = 0; row < kGlyphRows; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        dots.push_back(glyph_dot(letter, column, row));
    EXPECT_GT(std::count(dots.begin(), dots.end(), true), 0);
    EXPECT_EQ(std::count(seen.begin(), seen.end(), dots), 0) << static_cast<char>(letter);
    seen.push_back(dots);
  }
}

TEST(Font, utf8_is_taken_letter_by_letter_and_bad_bytes_one_by_one) {
  std::string_view text = "a°−\xff\xe2\x88";
  EXPECT_EQ(next_letter(text), U'a');
  EXPECT_EQ(next_letter(text), U'°');
  EXPECT_EQ(next_letter(text), U'−');
  for (int i = 0; i < 3; ++i) EXPECT_EQ(next_letter(text), U'\ufffd');
  EXPECT_TRUE(text.empty());
}

TEST(HeatColour, brightness_rises_evenly_from_black_to_white) {
  EXPECT_EQ(heat_colour(0), colours::kBlack);
  EXPECT_EQ(heat_colour(1), colours::kWhite);
  // Green's scheme is level in the luma that he uses: 0.30 R + 0.59 G + 0.11 B.
  for (int i = 0; i <= 100; ++i) {
    const Colour c = heat_colour(i / 100.0);
    EXPECT_NEAR(0.30 * c.r + 0.59 * c.g + 0.11 * c.b, 2.55 * i, 2.0) << i;
  }
}

TEST(HeatMap, squares_show_their_numbers_and_gaps_are_grey) {
  const std::vector<double> values = {0, 1, std::numeric_limits<double>::quiet_NaN(), 0.5};
  const hal::Image sut = heat_map(values, 2, 2, 0, 1, 3);
  EXPECT_EQ(sut.width(), 6);
  EXPECT_EQ(hal::rgb_at(sut.view(), 2, 2), colours::kBlack);
  EXPECT_EQ(hal::rgb_at(sut.view(), 3, 0), colours::kWhite);
  EXPECT_EQ(hal::rgb_at(sut.view(), 0, 5), colours::kGrey);
  EXPECT_EQ(hal::rgb_at(sut.view(), 5, 5), heat_colour(0.5));
}

TEST(SideBySide, images_of_any_format_stand_beside_each_other) {
  hal::Image grey(4, 6, hal::PixelFormat::kYuv444);
  for (std::uint8_t& byte : grey.bytes()) byte = 128;
  hal::Image white(2, 3, hal::PixelFormat::kRgb24);
  Canvas(white).fill(colours::kWhite);
  const hal::Image sut = side_by_side(grey.view(), white.view(), 1);
  EXPECT_EQ(sut.width(), 7);
  EXPECT_EQ(sut.height(), 6);
  EXPECT_EQ(hal::rgb_at(sut.view(), 3, 5), (Colour{128, 128, 128}));
  EXPECT_EQ(hal::rgb_at(sut.view(), 4, 0), colours::kBlack);
  EXPECT_EQ(hal::rgb_at(sut.view(), 6, 2), colours::kWhite);
  EXPECT_EQ(hal::rgb_at(sut.view(), 6, 3), colours::kBlack);
}

}  // namespace
}  // namespace gannet::image_file

// Drawing on RGB24 images: overlays on frames (a model's outline and axes) and previews. Points are
// in pixels, (0, 0) the centre of the first one; what lies outside is clipped, points that are not
// finite draw nothing. Deterministic. Normal threads only; the image is the caller's.
#pragma once

#include <span>
#include <string_view>

#include "hal/camera/image.hpp"
#include "hal/camera/pixel_access.hpp"

namespace gannet::image_file {

using Colour = hal::RgbPixel;

namespace colours {
inline constexpr Colour kBlack = {0, 0, 0}, kWhite = {255, 255, 255}, kGrey = {128, 128, 128};
inline constexpr Colour kRed = {230, 50, 40}, kGreen = {40, 200, 70}, kBlue = {60, 110, 255};
inline constexpr Colour kYellow = {255, 220, 40}, kCyan = {40, 220, 230}, kOrange = {255, 150, 30};
}  // namespace colours

struct Point {
  double x = 0;
  double y = 0;
};

class Canvas {
 public:
  // image: RGB24, must outlive the canvas.
  explicit Canvas(hal::Image& image);

  void fill(Colour colour);
  // Antialiased, with round ends; width in pixels, opacity 0 … 1.
  void line(Point a, Point b, Colour colour, double width = 1.5, double opacity = 1);
  void outline(std::span<const Point> corners, Colour colour, double width = 1.5);  // closed
  void polygon(std::span<const Point> corners, Colour colour, double opacity = 1);  // even-odd
  void circle(Point centre, double radius, Colour colour, double width = 1.5);
  void disc(Point centre, double radius, Colour colour, double opacity = 1);
  // With a head that is a fifth of its length.
  void arrow(Point from, Point to, Colour colour, double width = 2);

  // x, y: upper left corner; a letter's cell is 6 × 10 pixels times scale. UTF-8; letters that the
  // font lacks are drawn as a box. '\n' begins a new line.
  void text(int x, int y, std::string_view utf8, Colour colour, int scale = 1);
  // The same with a dark border, readable on any picture.
  void label(int x, int y, std::string_view utf8, Colour colour, int scale = 1);

  void blit(const hal::ImageView& source, int x, int y);

 private:
  void blend(int x, int y, Colour colour, double opacity);
  hal::Image& image_;
};

// Pixels that a text needs.
struct TextSize {
  int width = 0;
  int height = 0;
};
TextSize text_size(std::string_view utf8, int scale = 1);

hal::Image side_by_side(const hal::ImageView& left, const hal::ImageView& right, int gap = 4);

// x in 0 … 1 → a colour whose brightness rises evenly from black to white, so that it also reads
// in grey and for the colour-blind. Source: D. A. Green, Bull. Astr. Soc. India 39 (2011) 289,
// "cubehelix", start 0.5, −1.5 rotations, hue 1.
Colour heat_colour(double x);

// A map of numbers as a picture, each number a square of scale × scale pixels; low … high go dark
// to bright, what is not finite is grey. values: width·height, row by row.
hal::Image heat_map(std::span<const double> values, int width, int height, double low, double high,
                    int scale);

}  // namespace gannet::image_file

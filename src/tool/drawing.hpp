// Lines and dots on RGB pictures, for people's eyes. Coordinates as in images: (0, 0) is the
// centre of the first pixel; what lies outside the picture is left out. Normal thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "hal/camera/image.hpp"

namespace gannet::tool {

using Colour = std::array<std::uint8_t, 3>;
inline constexpr Colour kRed = {255, 48, 48};
inline constexpr Colour kGreen = {48, 220, 48};
inline constexpr Colour kBlue = {64, 128, 255};
inline constexpr Colour kMagenta = {255, 0, 255};
inline constexpr Colour kYellow = {255, 230, 0};

// picture: RGB24, as the ones below.
void draw_dot(hal::Image& picture, const Eigen::Vector2d& at, double radius, Colour colour);
void draw_line(hal::Image& picture, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
               double width, Colour colour);

// source put into picture with its first pixel at (x, y), each pixel enlarged to scale × scale.
void put(hal::Image& picture, const hal::Image& source, int x, int y, int scale);

}  // namespace gannet::tool

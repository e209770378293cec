// Pictures that are drawn by rule, for tests and for machines without the photographs: they are
// called drawn wherever they appear. All repeat seamlessly. Same bits for the same seed.
// Start-up only.
#pragma once

#include <cstdint>

#include "src/image_file/raster.hpp"

namespace gannet::world {

// Rounded stones of many colours and sizes with grain down to a texel; RGB.
image_file::Raster8 pebbles_picture(int side, std::uint64_t seed);

// Noise with equal power in every octave, coloured; RGB. Detail at any distance.
image_file::Raster8 noise_picture(int side, std::uint64_t seed);

// Slow browns and greens about a middle of 128, to colour a grey photograph of a bottom; RGB.
image_file::Raster8 pebbles_tint(int side, std::uint64_t seed);

// A standing person from behind as a flat board, 557 to 1756 in width and height: hair, a checked
// shirt, trousers with seams, shoes; RGBA, nothing around the figure.
image_file::Raster8 person_picture(std::uint64_t seed);

// Light gathered by waves; grey, linear mean about 1/4 where two copies overlap.
image_file::Raster8 caustics_picture();

}  // namespace gannet::world

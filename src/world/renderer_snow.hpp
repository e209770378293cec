// Marine snow: particles that drift through a cube which repeats in all directions, so that the
// camera always swims in it. Each is a small disc of light with the edge softened to a pixel, and
// the same sphere in the world for both eyes. Used by the renderer only, on any thread of its;
// deterministic.
#pragma once

#include <cstdint>
#include <vector>

#include "src/world/renderer_surface.hpp"
#include "src/world/scene.hpp"

namespace gannet::world {

// Draws over `light` (row-major, the camera's size). world_from_camera is that of either eye.
void draw_snow(const Scene& scene, double time_s, std::uint64_t seed,
               const Transform<World, LeftCamera>& world_from_camera, const Intrinsics& camera,
               const std::vector<Surface>& surfaces, const WaterTable& water,
               std::vector<Float4>& light);

}  // namespace gannet::world

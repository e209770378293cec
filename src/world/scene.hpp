// Scene: what can be seen, as values. Frames: World has z up; a flat thing is a rectangle in its
// own Target frame (x right, y down on the picture, z away from the viewer; origin in the middle),
// so that identity rotation to the left camera shows it squarely. Any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/core/transform.hpp"
#include "src/world/water.hpp"

namespace gannet::world {

struct SceneObject {
  int texture = 0;                                   // index in the renderer's textures
  Transform<World, Target> pose;                     // from its frame to the world
  Eigen::Vector2d size_m = Eigen::Vector2d::Ones();  // width, height of the rectangle
  double tile_m = 0;  // > 0: the texture repeats every tile_m (make it with Edge::kTile)
};

struct Light {
  double lux = 400;    // on a surface that faces it; what the sensor exposes for
  double ambient = 1;  // share of light that comes from everywhere; the rest from the sun
  Eigen::Vector3d sun = -Eigen::Vector3d::UnitZ();  // where sunlight travels to, world
  Eigen::Vector3d tint = Eigen::Vector3d::Ones();   // R, G, B
  // Sunlight gathered by waves into moving nets: 0 none … 1 strong; a pattern of about scale_m.
  double caustics = 0;
  double caustics_scale_m = 0.3;
};

// Marine snow: spheres adrift in a cube that repeats, the same ones for both eyes.
struct Particles {
  int count = 0;  // in the cube
  double cube_m = 2;
  double radius_m = 0.0008;
  double albedo = 0.6;
  Eigen::Vector3d drift_m_s = {0.01, 0.0, -0.02};
};

struct Scene {
  std::vector<SceneObject> background;  // walls and bottom, drawn in this order
  std::vector<SceneObject> objects;  // drawn from far to near by their middles; may not intersect
  Water water;
  Light light;
  Particles particles;
};

}  // namespace gannet::world

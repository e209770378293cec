#include "src/track/track_config.hpp"

namespace gannet::track {
namespace {

void describe_volume(Visitor& v, TrackConfig& c) {
  v.field("z_min_m", c.z_min_m,
          {.min = 0.02, .max = 100, .unit = "m", .help = "Nearest depth that is searched."});
  v.field("z_max_m", c.z_max_m,
          {.min = 0.02, .max = 100, .unit = "m", .help = "Farthest depth that is searched."});
  v.field("half_width_x_m", c.half_width_x_m,
          {.min = 0,
           .max = 100,
           .unit = "m",
           .help = "Sideways search range about the midpoint between the optical axes; 0: the "
                   "cameras' common field of view."});
  v.field("half_width_y_m", c.half_width_y_m,
          {.min = 0, .max = 100, .unit = "m", .help = "The same, up and down."});
  v.field("tilt_deg", c.tilt_deg,
          {.min = 0,
           .max = 85,
           .unit = "deg",
           .help = "Largest turn about x and y that is searched; R = Rz·Ry·Rx."});
  v.field("roll_deg", c.roll_deg,
          {.min = 0, .max = 180, .unit = "deg", .help = "Largest turn about z that is searched."});
}

}  // namespace

void describe(Visitor& v, TrackConfig& c) {
  v.field("fitness", c.fitness,
          {.choices = {"p001", "p002", "p000", "gannet"},
           .help = "How a pose is scored: votes of hue (p001, p002), left against right image "
                   "(p000, for rectangles), or normalised correlation (gannet)."});
  v.field("optimiser", c.optimiser,
          {.choices = {"rm_ga", "differential_evolution", "cma_es", "gannet"},
           .help = "How poses are searched."});
  v.field("evaluations", c.evaluations,
          {.min = 10,
           .max = 10000000,
           .help = "Poses scored in full, both images, when nothing is known."});
  v.field("evaluations_tracking", c.evaluations_tracking,
          {.min = 10, .max = 10000000, .help = "The same for each frame while locked."});
  v.field("seed", c.seed, {.min = 0, .help = "Of the search; the same seed gives the same pose."});
  v.field("model_points", c.model_points,
          {.min = 20, .max = 20000, .help = "Points inside a model's silhouette."});
  v.field("found_fitness", c.found_fitness,
          {.min = -1, .max = 1, .help = "Least correlation that counts as found (gannet)."});
  v.field("found_votes", c.found_votes,
          {.min = 0,
           .max = 1,
           .help = "Least share of a perfect score that counts as found (p000, p001, p002)."});
  describe_volume(v, c);
  v.field("coast_s", c.coast_s,
          {.min = 0,
           .max = 60,
           .unit = "s",
           .help = "A locked target unseen for longer is lost; until then its pose is predicted."});
  v.field("lock_frames", c.lock_frames,
          {.min = 1, .max = 100, .help = "Finds in a row before a target counts as locked."});
  v.group("search", c.search, "The optimisers.");
}

}  // namespace gannet::track

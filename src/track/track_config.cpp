#include "src/track/track_config.hpp"

namespace gannet::track {

void describe(Visitor& v, TrackConfig& c) {
  v.field("fitness", c.fitness,
          {.choices = {"gannet", "p000", "p001", "p002"},
           .help = "How images are compared with a target: gannet (correlation), or as in the "
                   "papers p001, p002 (hue votes, models) and p000 (Pb3DP, rectangles)."});
  v.field("optimiser", c.optimiser,
          {.choices = {"gannet", "rm_ga", "differential_evolution", "cma_es"},
           .help = "How poses are searched."});
  v.field("evaluations", c.evaluations,
          {.min = 10,
           .max = 10000000,
           .help = "Full stereo evaluations of one frame when the pose is not known."});
  v.field(
      "evaluations_tracking", c.evaluations_tracking,
      {.min = 10,
       .max = 10000000,
       .help = "Full stereo evaluations of one frame while locked, where it does not suffice to "
               "follow the prediction, and with other optimisers than gannet."});
  v.field("watch_candidates", c.watch_candidates,
          {.min = 12,
           .max = 512,
           .help = "Coarse candidates of one frame while locked that look for a better place "
                   "elsewhere."});
  v.field("refine", c.refine,
          {.help = "Refine what the search found to below a pixel; false: the search's own pose, "
                   "as in the papers."});
  v.field("seed", c.seed, {.min = 0, .max = 2147483647, .help = "Of the search's random numbers."});
  v.field("model_points", c.model_points,
          {.min = 32, .max = 2000, .help = "Wanted points on a model's target (S_in)."});
  v.field("found_likeness", c.found_likeness,
          {.min = 0,
           .max = 5,
           .help = "How alike (nats a sample) a model and both images must be at a pose, plus half "
                   "of its correlation's lead over the best place elsewhere, to count as found; "
                   "0.7 of it where the model was in the frame before."});
  v.field("found_fitness", c.found_fitness,
          {.min = 0,
           .max = 2,
           .help = "Least correlation of a rectangle, plus lead over the best depth elsewhere, "
                   "that counts as found."});
  v.field("found_votes", c.found_votes,
          {.min = 0,
           .max = 1,
           .help = "The same for the papers' votes, as a share of a perfect score."});
  v.field(
      "relief", c.relief,
      {.help = "While a model is locked, find by stereo what of it is not flat, and measure with "
               "that where it fits better."});
  v.field("z_min_m", c.z_min_m,
          {.min = 0.01, .max = 1000, .unit = "m", .help = "Nearest depth that is searched."});
  v.field("z_max_m", c.z_max_m,
          {.min = 0.01, .max = 1000, .unit = "m", .help = "Farthest depth that is searched."});
  v.field("half_width_x_m", c.half_width_x_m,
          {.min = 0,
           .max = 1000,
           .unit = "m",
           .help = "Half-width of the search about the midpoint between the optical axes; 0: the "
                   "common field of view."});
  v.field("half_width_y_m", c.half_width_y_m,
          {.min = 0, .max = 1000, .unit = "m", .help = "The same, downwards."});
  v.field("tilt_deg", c.tilt_deg,
          {.min = 0, .max = 80, .unit = "deg", .help = "Largest |θx| and |θy| that is searched."});
  v.field("roll_deg", c.roll_deg,
          {.min = 0, .max = 180, .unit = "deg", .help = "Largest |θz| that is searched."});
  v.field("coast_s", c.coast_s,
          {.min = 0,
           .max = 10,
           .unit = "s",
           .help = "How long an unseen target coasts before it is lost."});
  v.field("lock_frames", c.lock_frames,
          {.min = 1, .max = 100, .help = "Consecutive finds before the target is locked."});
  v.field("jump_m", c.jump_m,
          {.min = 0.001,
           .max = 100,
           .unit = "m",
           .help = "A find farther than this from the prediction is doubted until it has been "
                   "repeated lock_frames times."});
}

}  // namespace gannet::track

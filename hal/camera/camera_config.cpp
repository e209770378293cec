#include "hal/camera/camera_config.hpp"

#include "hal/camera/camera_kinds.hpp"

namespace gannet::hal {

void describe(Visitor& v, ReplayCameraConfig& c) {
  v.field("directory", c.directory,
          {.help = "Folder with left/ and right/ of PNG or JPEG files in name order, and perhaps "
                   "times.csv (frame,time_s)."});
  v.field("rate_hz", c.rate_hz,
          {.min = 0.01, .max = 1000, .unit = "Hz", .help = "Pairs per second without times.csv."});
  v.field("loop", c.loop, {.help = "Begin again after the last pair."});
  v.field("slots", c.slots,
          {.min = 2, .max = 64, .help = "Pairs in memory: decoded ahead, in work and archived."});
}

void describe(Visitor& v, SimulatedCameraConfig& c) {
  v.field("name", c.name,
          {.help = "Shared memory that gannet-world fills: a name in /dev/shm, or a path."});
  v.field("connect_timeout_s", c.connect_timeout_s,
          {.min = 0, .max = 3600, .unit = "s", .help = "How long to wait for it at the start."});
  v.field("silence_s", c.silence_s,
          {.min = 0.01,
           .max = 3600,
           .unit = "s",
           .help = "Without a pair for so long the camera counts as lost and is opened anew."});
}

void describe(Visitor& v, CameraConfig& c) {
  v.field("kind", c.kind, {.choices = camera_kinds(), .help = "Where image pairs come from."});
  v.group("replay", c.replay, "Recorded pairs from files.");
  v.group("simulated", c.simulated, "Pairs of a simulated world through shared memory.");
}

}  // namespace gannet::hal

#include "hal/camera/camera_config.hpp"

#include "hal/camera/camera_kinds.hpp"

namespace gannet::hal {
namespace {

// In the group of the kind itself, so that there is no deeper table to write.
void describe_stream(Visitor& v, V4l2StreamConfig& c) {
  v.field("width", c.width,
          {.min = 2, .max = 16384, .unit = "px", .help = "Width of the device's image."});
  v.field("height", c.height,
          {.min = 2, .max = 16384, .unit = "px", .help = "Height of the device's image."});
  v.field("format", c.format,
          {.choices = {"yuyv", "uyvy", "nv12", "mjpeg"},
           .help = "Pixel format. mjpeg is decoded on a thread of its own and takes longer."});
  v.field(
      "rate_hz", c.rate_hz,
      {.min = 0, .max = 1000, .unit = "Hz", .help = "Images per second; 0: as the driver has it."});
  v.field(
      "controls", c.controls,
      {.help = "Controls, set in this order and read back: \"name=value\", names as `gannet "
               "cameras` tells them. Switch the automatic white balance off: it moves the hue."});
  v.field("buffers", c.buffers,
          {.min = 3, .max = 32, .help = "Buffers asked of the driver; frames in work hold some."});
  v.field("accept_unknown_clock", c.accept_unknown_clock,
          {.help = "Accept a driver that does not say of which clock its time stamps are; they are "
                   "taken for those of CLOCK_MONOTONIC where they are near it."});
  v.field("exposure_s", c.exposure_s,
          {.min = 0,
           .max = 1,
           .unit = "s",
           .help = "Exposure time as set by the controls; half of it lies between a stamp and the "
                   "middle of the exposure."});
  v.field("readout_s", c.readout_s,
          {.min = 0,
           .max = 1,
           .unit = "s",
           .help = "From the end of the exposure to a stamp of the frame's end; not used where the "
                   "driver stamps the exposure's start."});
  v.field(
      "connect_timeout_s", c.connect_timeout_s,
      {.min = 0, .max = 3600, .unit = "s", .help = "How long to wait for a device at the start."});
  v.field("silence_s", c.silence_s,
          {.min = 0.02,
           .max = 3600,
           .unit = "s",
           .help = "Without a good image for so long a device counts as lost and is opened anew."});
  v.field("decode_limit_s", c.decode_limit_s,
          {.min = 0.001,
           .max = 10,
           .unit = "s",
           .help = "mjpeg: a pair that is not decoded in this time is dropped."});
  v.field("decoded_slots", c.decoded_slots,
          {.min = 2, .max = 64, .help = "mjpeg: decoded pairs in memory, in work and archived."});
}

}  // namespace

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

void describe(Visitor& v, V4l2PairConfig& c) {
  v.field("left", c.left, {.help = "The left camera's device; choose by /dev/v4l/by-path."});
  v.field("right", c.right, {.help = "The right camera's device."});
  v.field("pair_tolerance_s", c.pair_tolerance_s,
          {.min = 0,
           .max = 1,
           .unit = "s",
           .help = "How far apart the time stamps of a pair may be; less than half a period."});
  describe_stream(v, c.stream);
}

void describe(Visitor& v, V4l2SideBySideConfig& c) {
  v.field("device", c.device, {.help = "The device; choose by /dev/v4l/by-path."});
  v.field("right_first", c.right_first,
          {.help = "The right camera's image is the left half of the device's."});
  describe_stream(v, c.stream);
}

void describe(Visitor& v, CameraConfig& c) {
  v.field("kind", c.kind, {.choices = camera_kinds(), .help = "Where image pairs come from."});
  v.group("replay", c.replay, "Recorded pairs from files.");
  v.group("simulated", c.simulated, "Pairs of a simulated world through shared memory.");
  v.group("v4l2_pair", c.v4l2_pair, "Two V4L2 devices, paired by their time stamps.");
  v.group("v4l2_side_by_side", c.v4l2_side_by_side,
          "One V4L2 device whose image holds both cameras' side by side.");
}

}  // namespace gannet::hal

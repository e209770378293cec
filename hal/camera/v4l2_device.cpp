#include "hal/camera/v4l2_device.hpp"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

#include "hal/camera/v4l2_controls.hpp"
#include "hal/camera/v4l2_offer.hpp"

namespace gannet::hal {
namespace {

v4l2_buffer buffer_at(int index) {
  v4l2_buffer buffer = {};
  buffer.index = static_cast<std::uint32_t>(index);
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  return buffer;
}

// ENOENT, ENODEV, ENXIO: not plugged in yet. EACCES: udev has not given us the right yet. EBUSY,
// EIO, EINVAL of a stream: a loop-back device without its writer.
bool passes(int error) {
  for (const int one : {ENOENT, ENODEV, ENXIO, EACCES, EBUSY, EIO})
    if (error == -one) return true;
  return false;
}

Error failed(const std::string& path, const char* what, int error) {
  return Error{path + ": " + what + ": " + std::strerror(-error)};
}

std::size_t least_bytes(const V4l2Format& format) {
  return format.compressed ? 4 : format.bytes;  // a JPEG has at least its two markers
}

}  // namespace

// ---- opening
// -------------------------------------------------------------------------------------

V4l2Device::V4l2Device(V4l2System& system, int fd, const V4l2StreamConfig& config)
    : system_(system), fd_(fd), config_(config) {}

Result<std::unique_ptr<V4l2Device>> V4l2Device::open(V4l2System& system, const std::string& path,
                                                     const V4l2StreamConfig& config,
                                                     bool& may_pass) {
  const int fd = system.open(path);
  may_pass = passes(fd);
  if (fd < 0) return failed(path, "cannot open", fd);
  std::unique_ptr<V4l2Device> device(new V4l2Device(system, fd, config));
  if (const auto done = device->set_up(path, may_pass); !done) return done.error();
  return device;
}

Result<void> V4l2Device::set_up(const std::string& path, bool& may_pass) {
  const auto offer = read_offer(system_, fd_, path);
  if (!offer) return offer.error();
  if (!offer->captures)
    return Error{path + ": (" + offer->card +
                 ") gives no images; `gannet cameras` lists those that do"};
  if (!offer->streams) return Error{path + ": (" + offer->card + ") has no mapped buffers"};
  auto format = negotiate(system_, fd_, path, config_);
  if (!format) {
    // A loop-back device offers nothing while nobody writes into it.
    may_pass = offer->formats.empty();
    return format.error();
  }
  format_ = *format;
  judge_ = V4l2Judge(least_bytes(format_), config_.accept_unknown_clock);
  if (auto applied = apply_controls(system_, fd_, path, config_.controls); !applied) return applied;
  if (auto mapped = map_buffers(path, may_pass); !mapped) return mapped;
  for (int i = 0; i < count_; ++i)
    if (!queue(i))
      return Error{path + ": the driver does not take its buffer " + std::to_string(i)};
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  const int error = system_.ioctl(fd_, VIDIOC_STREAMON, &type);
  may_pass = passes(error);
  if (error != 0) return failed(path, "cannot start the stream", error);
  return {};
}

Result<void> V4l2Device::map_buffers(const std::string& path, bool& may_pass) {
  v4l2_requestbuffers request = {};
  request.count = static_cast<std::uint32_t>(std::min(config_.buffers, kMostBuffers));
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  const int error = system_.ioctl(fd_, VIDIOC_REQBUFS, &request);
  may_pass = passes(error);
  if (error != 0) return failed(path, "gives no buffers", error);
  if (request.count < 2)
    return Error{path + ": the driver has " + std::to_string(request.count) +
                 " buffers; at least 2 are needed"};
  count_ = static_cast<int>(std::min<std::uint32_t>(request.count, kMostBuffers));
  pool_ = std::make_unique<LeasePool>(count_);
  for (int i = 0; i < count_; ++i)
    if (auto mapped = map_buffer(path, i); !mapped) {
      may_pass = true;  // v4l2loopback without its writer
      return mapped;
    }
  may_pass = false;
  if (names_its_clock_ || config_.accept_unknown_clock) return {};
  return Error{path +
               ": its driver does not say that time stamps are of CLOCK_MONOTONIC; if they "
               "are, accept_unknown_clock = true takes it at its word"};
}

Result<void> V4l2Device::map_buffer(const std::string& path, int index) {
  v4l2_buffer query = buffer_at(index);
  if (const int error = system_.ioctl(fd_, VIDIOC_QUERYBUF, &query); error != 0)
    return failed(path, "does not tell of its buffers", error);
  Buffer& buffer = buffers_[static_cast<std::size_t>(index)];
  buffer.bytes = query.length;
  buffer.memory =
      static_cast<std::uint8_t*>(system_.map(fd_, query.length, std::int64_t{query.m.offset}));
  if (buffer.memory == nullptr) return Error{path + ": its buffers cannot be mapped"};
  if (buffer.bytes < least_bytes(format_))
    return Error{path + ": its buffers are smaller than an image"};
  // The clock is a constant of the stream and told beforehand.
  names_its_clock_ =
      (query.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  return {};
}

V4l2Device::~V4l2Device() {
  assert(pool_ == nullptr || all_home());
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  system_.ioctl(fd_, VIDIOC_STREAMOFF, &type);
  for (const Buffer& buffer : buffers_)
    if (buffer.memory != nullptr) system_.unmap(buffer.memory, buffer.bytes);
  system_.close(fd_);
}

// ---- capture thread
// ------------------------------------------------------------------------------

bool V4l2Device::queue(int index) {
  v4l2_buffer buffer = buffer_at(index);
  if (system_.ioctl(fd_, VIDIOC_QBUF, &buffer) != 0) return false;
  buffers_[static_cast<std::size_t>(index)].queued = true;
  ++queued_;
  return true;
}

// What the driver refuses now is offered again the next time; if it goes on refusing it runs out
// of buffers, falls silent and is opened anew.
void V4l2Device::queue_returned() {
  if (queued_ == count_) return;
  for (int i = 0; i < count_; ++i)
    if (!buffers_[static_cast<std::size_t>(i)].queued && pool_->is_free(i)) queue(i);
}

V4l2Taken V4l2Device::take(TimePoint now, CaptureCounters& counters, V4l2Image& image) {
  queue_returned();
  v4l2_buffer buffer = buffer_at(0);
  const int error = system_.ioctl(fd_, VIDIOC_DQBUF, &buffer);
  if (error == -EAGAIN) return V4l2Taken::kNothing;
  // EIO may have cost the driver a buffer without saying which: only a new start is clean.
  if (error != 0 || buffer.index >= static_cast<std::uint32_t>(count_)) return V4l2Taken::kGone;
  const int index = static_cast<int>(buffer.index);
  Buffer& slot = buffers_[buffer.index];
  // v4l2loopback writes round and round, whoever holds a buffer: what it gives may be one that is
  // not its own.
  const bool is_theirs = std::exchange(slot.queued, false);
  if (is_theirs) --queued_;
  const V4l2Fault fault = judge_.judge(buffer, now);
  // A stream's first image is not to be trusted: v4l2loopback hands out what lay in its buffer,
  // seconds old, with a new stamp; sensors may have exposed it half.
  if (std::exchange(is_first_, false)) {
    if (is_theirs) queue(index);
    return V4l2Taken::kNothing;
  }
  count(fault, counters);
  counters.missed += judge_.missed();
  counters.dropped += judge_.missed();
  number_ += 1 + judge_.missed();
  // The driver keeps two buffers, or it would lose frames that are newer than those we hold.
  const bool has_slot = is_theirs && queued_ >= std::min(2, count_ - 1);
  if (fault != V4l2Fault::kNone || !has_slot) {
    if (is_theirs) queue(index);
    if (fault != V4l2Fault::kNone) return V4l2Taken::kRefused;
    ++counters.dropped;
    return V4l2Taken::kNoSlot;
  }
  image.lease = pool_->lend_slot(index);
  image.bytes = {slot.memory, std::min<std::size_t>(buffer.bytesused, slot.bytes)};
  image.stamp = judge_.stamp();
  image.exposure = middle_of_exposure(buffer.flags, image.stamp, now);
  image.number = number_;
  return V4l2Taken::kImage;
}

// Stamps are of the frame's end, or of the exposure's start. What is to be seen is the past: a
// stamp ahead of our clock would have predictions run backwards.
TimePoint V4l2Device::middle_of_exposure(std::uint32_t flags, TimePoint stamp,
                                         TimePoint now) const {
  const Duration half = from_seconds(config_.exposure_s / 2);
  const bool at_start = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return std::min(now, at_start ? stamp + half : stamp - half - from_seconds(config_.readout_s));
}

}  // namespace gannet::hal

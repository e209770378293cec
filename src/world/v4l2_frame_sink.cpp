#include "src/world/v4l2_frame_sink.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace gannet::world {
namespace {

constexpr std::uint32_t kBuffers = 8;
constexpr v4l2_buf_type kType = V4L2_BUF_TYPE_VIDEO_OUTPUT;

v4l2_buffer buffer_of(std::uint32_t index) {
  v4l2_buffer buffer = {};
  buffer.type = kType;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

}  // namespace

// ---- V4l2Output ---------------------------------------------------------------------------------

Error V4l2Output::error(const char* call, int result) const {
  return Error{path_ + ": " + call + ": " + std::strerror(-result)};
}

Result<V4l2Output> V4l2Output::open(const std::string& path, int width, int height, double rate_hz,
                                    hal::V4l2System& system) {
  const int fd = system.open(path);
  V4l2Output output(path, fd, system);
  if (fd < 0) return output.error("open", fd);
  const auto started = output.start(width, height, rate_hz);
  if (!started) return started.error();
  return output;
}

V4l2Output::V4l2Output(V4l2Output&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      system_(other.system_),
      buffers_(std::exchange(other.buffers_, {})),
      next_(other.next_) {}

V4l2Output::~V4l2Output() {
  for (const Mapping& buffer : buffers_) system_->unmap(buffer.memory, buffer.bytes);
  if (fd_ >= 0) system_->close(fd_);
}

Result<void> V4l2Output::start(int width, int height, double rate_hz) {
  v4l2_capability capability = {};
  if (const int r = system_->ioctl(fd_, VIDIOC_QUERYCAP, &capability); r < 0)
    return error("QUERYCAP", r);
  const std::uint32_t abilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                      ? capability.device_caps
                                      : capability.capabilities;
  if ((abilities & V4L2_CAP_VIDEO_OUTPUT) == 0)
    return Error{path_ + " takes no pictures; is it a device of v4l2loopback?"};

  v4l2_format format = {};
  format.type = kType;
  format.fmt.pix.width = static_cast<std::uint32_t>(width);
  format.fmt.pix.height = static_cast<std::uint32_t>(height);
  format.fmt.pix.pixelformat = V4L2_PIX_FMT_YUYV;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = 2 * format.fmt.pix.width;
  format.fmt.pix.sizeimage = format.fmt.pix.bytesperline * format.fmt.pix.height;
  format.fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
  const v4l2_pix_format asked = format.fmt.pix;
  if (const int r = system_->ioctl(fd_, VIDIOC_S_FMT, &format); r < 0) return error("S_FMT", r);
  const v4l2_pix_format& got = format.fmt.pix;
  if (got.width != asked.width || got.height != asked.height ||
      got.pixelformat != asked.pixelformat || got.bytesperline != asked.bytesperline)
    return Error{path_ + " keeps another format than " + std::to_string(width) + "x" +
                 std::to_string(height) + " YUYV: has somebody opened it before?"};

  v4l2_streamparm rate = {};
  rate.type = kType;
  rate.parm.output.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(1000 * rate_hz))};
  system_->ioctl(fd_, VIDIOC_S_PARM, &rate);  // a hint to readers alone

  const auto mapped = map_buffers();
  if (!mapped) return mapped;
  int type = kType;
  if (const int r = system_->ioctl(fd_, VIDIOC_STREAMON, &type); r < 0) return error("STREAMON", r);
  return {};
}

Result<void> V4l2Output::map_buffers() {
  v4l2_requestbuffers request = {};
  request.type = kType;
  request.memory = V4L2_MEMORY_MMAP;
  request.count = kBuffers;
  if (const int r = system_->ioctl(fd_, VIDIOC_REQBUFS, &request); r < 0)
    return error("REQBUFS", r);
  for (std::uint32_t i = 0; i < request.count; ++i) {
    v4l2_buffer buffer = buffer_of(i);
    if (const int r = system_->ioctl(fd_, VIDIOC_QUERYBUF, &buffer); r < 0)
      return error("QUERYBUF", r);
    void* const memory = system_->map(fd_, buffer.length, buffer.m.offset);
    if (memory == nullptr) return Error{path_ + ": its buffers cannot be mapped"};
    buffers_.push_back({memory, buffer.length});
  }
  if (buffers_.empty()) return Error{path_ + ": REQBUFS gave no buffer"};
  return {};
}

bool V4l2Output::show(std::span<const std::uint8_t> image, std::size_t bytes, TimePoint stamp) {
  // v4l2loopback has one set of buffers for writer and reader; when a reader asked for less, a
  // number stands for another buffer than before, and the driver must be asked which.
  v4l2_buffer buffer = buffer_of(next_++ % static_cast<std::uint32_t>(buffers_.size()));
  if (system_->ioctl(fd_, VIDIOC_QUERYBUF, &buffer) < 0) return false;
  if (buffer.index >= buffers_.size() || buffers_[buffer.index].bytes < image.size()) return false;
  std::memcpy(buffers_[buffer.index].memory, image.data(), image.size());

  v4l2_buffer queued = buffer_of(buffer.index);
  queued.field = V4L2_FIELD_NONE;
  queued.bytesused = static_cast<std::uint32_t>(bytes);
  queued.length = buffer.length;
  const std::int64_t us = to_ns(stamp) / 1000;
  queued.timestamp = {us / 1'000'000, us % 1'000'000};
  return system_->ioctl(fd_, VIDIOC_QBUF, &queued) == 0;
}

// ---- V4l2FrameSink ------------------------------------------------------------------------------

Result<std::unique_ptr<FrameSink>> V4l2FrameSink::create(const Config& config,
                                                         hal::V4l2System& system) {
  const hal::ImageLayout layout = hal::layout_of(kFormat, config.width, config.height);
  if (layout.bytes == 0) return Error{"V4L2 cameras need an even width"};
  auto left =
      V4l2Output::open(config.devices[0], config.width, config.height, config.rate_hz, system);
  if (!left) return left.error();
  auto right =
      V4l2Output::open(config.devices[1], config.width, config.height, config.rate_hz, system);
  if (!right) return right.error();
  std::unique_ptr<V4l2FrameSink> sink(
      new V4l2FrameSink(std::move(*left), std::move(*right), layout, system));
  if (config.has_thread) sink->thread_ = std::thread([s = sink.get()] { s->work(); });
  return std::unique_ptr<FrameSink>(std::move(sink));
}

V4l2FrameSink::V4l2FrameSink(V4l2Output left, V4l2Output right, const hal::ImageLayout& layout,
                             hal::V4l2System& system)
    : layout_(layout), system_(system), outputs_{std::move(left), std::move(right)} {
  for (Pair& pair : pairs_)
    for (auto& image : pair.image) image.resize(layout_.bytes);
}

V4l2FrameSink::~V4l2FrameSink() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

std::optional<FrameSink::Images> V4l2FrameSink::begin_frame() {
  const std::lock_guard lock(mutex_);
  for (int i = 0; i < kPairs; ++i) {
    Pair& pair = pairs_[static_cast<std::size_t>(i)];
    if (pair.waiting > 0) continue;
    drawing_ = i;
    return Images{pair.image[kLeftSide], pair.image[kRightSide]};
  }
  return std::nullopt;
}

void V4l2FrameSink::publish(const PairTimes& times) {
  {
    const std::lock_guard lock(mutex_);
    for (const Side side : {kLeftSide, kRightSide}) {
      const ImageTimes& image = times.of[side];
      const auto later = std::find_if(handovers_.begin(), handovers_.end(),
                                      [&](const Handover& h) { return h.due > image.available; });
      handovers_.insert(later, {image.available, image.stamp, drawing_, side, times.is_short});
    }
    pairs_[static_cast<std::size_t>(drawing_)].waiting = 2;
  }
  wake_.notify_one();
}

void V4l2FrameSink::hand_over_due(TimePoint now) {
  const std::size_t whole =
      static_cast<std::size_t>(layout_.stride[0]) * static_cast<std::size_t>(layout_.rows[0]);
  std::unique_lock lock(mutex_);
  while (!handovers_.empty() && handovers_.front().due <= now) {
    const Handover handover = handovers_.front();
    handovers_.pop_front();
    Pair& pair = pairs_[static_cast<std::size_t>(handover.pair)];
    lock.unlock();  // the image is ours while it waits
    const bool shown =
        outputs_[handover.side].show(std::span(pair.image[handover.side]).first(whole),
                                     handover.is_short ? whole / 3 : whole, handover.stamp);
    lock.lock();
    --pair.waiting;
    refused_ += shown ? 0 : 1;
  }
}

void V4l2FrameSink::work() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (handovers_.empty()) {
      wake_.wait(lock);
      continue;
    }
    const Duration wait = handovers_.front().due - system_.now();
    if (wait > Duration{}) {
      wake_.wait_for(lock, wait);
      continue;
    }
    lock.unlock();
    hand_over_due(system_.now());
    lock.lock();
  }
}

}  // namespace gannet::world

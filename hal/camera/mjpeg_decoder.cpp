#include "hal/camera/mjpeg_decoder.hpp"

#include <sys/eventfd.h>

#include <cerrno>
#include <utility>

#include "platform/base/log.hpp"
#include "platform/linux/clock.hpp"

namespace gannet::hal {

Result<std::unique_ptr<MjpegDecoder>> MjpegDecoder::create(const Setting& setting,
                                                           DecodeImage decode, V4l2System& system) {
  const int ready = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (ready < 0) return linux_os::system_error("camera: eventfd", errno);
  std::unique_ptr<MjpegDecoder> decoder(new MjpegDecoder(setting, decode, system, ready));
  auto thread =
      linux_os::Thread::start("mjpeg", {}, [self = decoder.get()] { self->decode_loop(); });
  if (!thread) return thread.error();
  decoder->thread_ = std::move(*thread);
  return decoder;
}

MjpegDecoder::MjpegDecoder(const Setting& setting, DecodeImage decode, V4l2System& system,
                           int ready)
    : setting_(setting),
      decode_(decode),
      system_(system),
      ready_(ready),
      slots_(static_cast<std::size_t>(setting.slots)),
      pool_(setting.slots),
      done_(setting.slots) {}

MjpegDecoder::~MjpegDecoder() {
  stop_.store(true, std::memory_order_release);
  news_.fetch_add(1, std::memory_order_release);
  linux_os::futex_wake_all(news_);
  thread_.join();
}

// ---- capture thread
// ------------------------------------------------------------------------------

bool MjpegDecoder::submit(V4l2Images&& images) {
  Job job = {std::move(images), system_.now()};
  if (!jobs_.push(std::move(job))) {
    images = std::move(job.images);
    return false;
  }
  news_.fetch_add(1, std::memory_order_release);
  linux_os::futex_wake_all(news_);
  return true;
}

bool MjpegDecoder::take(Decoded& decoded) {
  // Emptied before the look: what is pushed after it makes the descriptor readable again.
  eventfd_t count = 0;
  ::eventfd_read(ready_.get(), &count);
  if (!done_.pop(decoded)) return false;
  if (done_.size() > 0) ::eventfd_write(ready_.get(), 1);
  return true;
}

// ---- decoder thread
// ------------------------------------------------------------------------------

void MjpegDecoder::decode_loop() {
  while (!stop_.load(std::memory_order_acquire)) {
    const std::uint32_t news = news_.load(std::memory_order_acquire);
    Job job;
    if (jobs_.pop(job))
      work(std::move(job));
    else if (!stop_.load(std::memory_order_acquire))
      linux_os::futex_wait(news_, news, linux_os::monotonic_now() + std::chrono::seconds(1));
  }
}

bool MjpegDecoder::is_late(const Job& job) {
  if (system_.now() - job.submitted <= setting_.limit) return false;
  late_.fetch_add(1, std::memory_order_relaxed);
  return true;
}

void MjpegDecoder::work(Job job) {
  if (is_late(job)) return;
  Decoded decoded;
  decoded.lease = pool_.lend();
  if (!decoded.lease.valid()) {
    without_slot_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  auto& slot = slots_[static_cast<std::size_t>(decoded.lease.slot())];
  decoded.broken = !decode_pair(job.images, slot);
  if (!decoded.broken && is_late(job)) return;
  for (std::size_t i = 0; i < 2; ++i) decoded.view[i] = slot[i].view();
  decoded.exposure = job.images.exposure;
  decoded.number = job.images.number;
  // Never full: it has room for every slot, and each element holds one.
  done_.push(std::move(decoded));
  ::eventfd_write(ready_.get(), 1);
}

bool MjpegDecoder::decode_pair(const V4l2Images& images, std::array<Image, 2>& out) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(setting_.images); ++i) {
    auto image = decode_(images.image[i].bytes);
    const bool fits =
        image && image->width() == setting_.width && image->height() == setting_.height;
    // Once: a bad cable would fill the log.
    if (!fits && !std::exchange(told_, true))
      log(Severity::kWarning, "camera: an image was not decoded: " +
                                  (image ? "its size is another one" : image.error().text));
    if (!fits) return false;
    out[i] = std::move(*image);
  }
  return true;
}

}  // namespace gannet::hal

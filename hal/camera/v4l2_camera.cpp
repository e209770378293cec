#include "hal/camera/v4l2_camera.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace gannet::hal {
namespace {

// While a device is away nothing wakes us when it is back.
constexpr Duration kLookAgain = std::chrono::milliseconds(20);

Duration period_of(const V4l2StreamConfig& stream) {
  return from_seconds(1 / (stream.rate_hz > 0 ? stream.rate_hz : 30));
}

}  // namespace

Result<std::unique_ptr<StereoCamera>> V4l2Camera::create(const Setting& setting, DecodeImage decode,
                                                         V4l2System& system) {
  if (setting.stream.format == "mjpeg" && decode == nullptr)
    return Error{"camera: mjpeg cannot be decoded here"};
  return std::unique_ptr<StereoCamera>(new V4l2Camera(setting, decode, system));
}

V4l2Camera::V4l2Camera(const Setting& setting, DecodeImage decode, V4l2System& system)
    : setting_(setting),
      decode_(decode),
      system_(system),
      pairing_(setting.tolerance, period_of(setting.stream)) {
  for (const std::string& path : setting.paths)
    links_.push_back(std::make_unique<V4l2Link>(system, path, setting.stream));
}

Result<void> V4l2Camera::start() {
  for (auto& link : links_)
    if (auto started = link->start(); !started) return started;
  if (!links_[0]->format().compressed) return {};
  const V4l2StreamConfig& stream = setting_.stream;
  auto decoder = MjpegDecoder::create({.images = static_cast<int>(links_.size()),
                                       .width = stream.width,
                                       .height = stream.height,
                                       .slots = stream.decoded_slots,
                                       .limit = from_seconds(stream.decode_limit_s)},
                                      decode_, system_);
  if (!decoder) return decoder.error();
  decoder_ = std::move(*decoder);
  return {};
}

CaptureStatus V4l2Camera::capture(TimePoint now, Duration timeout, StereoFrame& frame) {
  const TimePoint deadline = now + timeout;
  for (;;) {
    const CaptureStatus status = look(now, frame);
    if (status != CaptureStatus::kNothing && status != CaptureStatus::kLost) return status;
    if (now >= deadline) return status;
    wait(lost_ ? std::min(deadline, now + kLookAgain) : deadline);
    now = system_.now();
  }
}

// One look without waiting: what is decoded, then what the devices have.
CaptureStatus V4l2Camera::look(TimePoint now, StereoFrame& frame) {
  MjpegDecoder::Decoded decoded;
  if (decoder_ && decoder_->take(decoded)) return deliver_decoded(std::move(decoded), frame);
  const CaptureStatus taken = take_from_devices(now);
  const std::uint64_t unpaired = pairing_.unpaired();
  V4l2Images images;
  if (next_images(images)) return hand_on(std::move(images), frame);
  return pairing_.unpaired() != unpaired ? CaptureStatus::kBroken : taken;
}

// At most one image of each device, so that no device is served before its twin for long.
CaptureStatus V4l2Camera::take_from_devices(TimePoint now) {
  CaptureStatus status = CaptureStatus::kNothing;
  lost_ = false;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const auto side = static_cast<PairByTime::Side>(i);
    V4l2Image image;
    switch (links_[i]->take(now, counters_, image)) {
      case V4l2Taken::kImage:
        if (is_pair())
          pairing_.put(side, std::move(image));
        else
          single_ = std::move(image);
        break;
      case V4l2Taken::kNothing:
        break;
      case V4l2Taken::kRefused:
        if (!lost_) status = CaptureStatus::kBroken;
        break;
      case V4l2Taken::kNoSlot:
        if (!lost_) status = CaptureStatus::kNoSlot;
        break;
      case V4l2Taken::kGone:
        // Its images must go home before it can be opened anew.
        pairing_.clear(side);
        lost_ = true;
        status = CaptureStatus::kLost;
        break;
    }
  }
  return status;
}

bool V4l2Camera::next_images(V4l2Images& images) {
  auto& [first, second] = images.image;
  if (is_pair()) {
    if (!pairing_.take(first, second)) return false;
    images.exposure = first.exposure + (second.exposure - first.exposure) / 2;
  } else {
    first = std::exchange(single_, V4l2Image{});
    if (!first.lease.valid()) return false;
    images.exposure = first.exposure;
  }
  images.number = first.number;
  return true;
}

CaptureStatus V4l2Camera::hand_on(V4l2Images images, StereoFrame& frame) {
  if (!decoder_) return deliver(std::move(images), frame);
  if (decoder_->submit(std::move(images))) return CaptureStatus::kNothing;
  ++counters_.decoded_late;
  ++counters_.dropped;
  return CaptureStatus::kNoSlot;
}

CaptureStatus V4l2Camera::deliver(V4l2Images images, StereoFrame& frame) {
  auto& [first, second] = images.image;
  const ImageView left = view_of(links_[0]->format(), first.bytes.data());
  set_views(left, is_pair() ? view_of(links_[1]->format(), second.bytes.data()) : left, frame);
  frame.left_lease = std::move(first.lease);
  frame.right_lease = std::move(second.lease);
  frame.capture_time = images.exposure;
  frame.number = images.number;
  ++counters_.frames;
  return CaptureStatus::kFrame;
}

CaptureStatus V4l2Camera::deliver_decoded(MjpegDecoder::Decoded decoded, StereoFrame& frame) {
  if (decoded.broken) {
    ++counters_.undecoded;
    ++counters_.broken;
    return CaptureStatus::kBroken;
  }
  set_views(decoded.view[0], decoded.view[is_pair() ? 1 : 0], frame);
  frame.left_lease = std::move(decoded.lease);
  frame.right_lease = Lease{};
  frame.capture_time = decoded.exposure;
  frame.number = decoded.number;
  ++counters_.frames;
  return CaptureStatus::kFrame;
}

void V4l2Camera::set_views(const ImageView& first, const ImageView& second,
                           StereoFrame& frame) const {
  frame.left = first;
  frame.right = second;
  if (is_pair()) return;
  frame.left = columns_of(first, setting_.right_first ? width() : 0, width());
  frame.right = columns_of(first, setting_.right_first ? 0 : width(), width());
}

CaptureCounters V4l2Camera::counters() const {
  CaptureCounters counters = counters_;
  counters.unpaired = pairing_.unpaired();
  counters.broken += counters.unpaired;
  counters.skew_s = to_seconds(pairing_.skew());
  counters.skew_max_s = to_seconds(pairing_.largest_skew());
  if (!decoder_) return counters;
  counters.decoded_late += decoder_->late();
  counters.dropped += decoder_->late() + decoder_->without_slot();
  return counters;
}

void V4l2Camera::wait(TimePoint until) {
  std::array<pollfd, 3> fds;
  std::size_t count = 0;
  for (const auto& link : links_) fds[count++] = {link->fd(), POLLIN, 0};  // −1 is passed over
  if (decoder_) fds[count++] = {decoder_->fd(), POLLIN, 0};
  if (system_.poll({fds.data(), count}, until) <= 0) return;
  for (std::size_t i = 0; i < links_.size(); ++i)
    if ((fds[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) links_[i]->note_error();
}

}  // namespace gannet::hal

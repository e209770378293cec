#include "hal/camera/replay_source.hpp"

#include <utility>

#include "platform/linux/whole_file.hpp"

namespace gannet::hal {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 29;

std::string size_text(int width, int height) {
  return std::to_string(width) + " × " + std::to_string(height);
}

}  // namespace

Result<ReplaySource> ReplaySource::open(const std::string& directory, double rate_hz, bool loop,
                                        DecodeImage decode) {
  ReplaySource source;
  auto frames = list_frames(directory, rate_hz);
  if (!frames) return frames.error();
  source.frames_ = std::move(*frames);
  source.loop_ = loop;
  source.decode_ = decode;
  const auto left = source.read(source.frames_.pairs[0].left);
  if (!left) return left.error();
  source.width_ = left->width();
  source.height_ = left->height();
  ReplayPair first;
  if (const auto loaded = source.load(0, first); !loaded) return loaded.error();
  return source;
}

Duration ReplaySource::due(std::uint64_t index) const {
  const auto& pairs = frames_.pairs;
  const double first_s = pairs.front().time_s;
  const double lap_s = pairs.back().time_s - first_s + frames_.interval_s;
  return from_seconds(static_cast<double>(index / pairs.size()) * lap_s +
                      pairs[index % pairs.size()].time_s - first_s);
}

Result<Image> ReplaySource::read(const std::string& path) const {
  const auto bytes = linux_os::read_file(path, kMaxFileBytes);
  if (!bytes) return bytes.error();
  auto image = decode_(*bytes);
  if (!image) return Error{path + ": " + image.error().text};
  if (width_ != 0 && (image->width() != width_ || image->height() != height_))
    return Error{path + ": " + size_text(image->width(), image->height()) +
                 " pixels, but the first left image has " + size_text(width_, height_)};
  return image;
}

Result<void> ReplaySource::load(std::uint64_t index, ReplayPair& pair) const {
  const FramePair& files = frames_.pairs[index % frames_.pairs.size()];
  auto left = read(files.left);
  if (!left) return left.error();
  auto right = read(files.right);
  if (!right) return right.error();
  pair.left = std::move(*left);
  pair.right = std::move(*right);
  return {};
}

}  // namespace gannet::hal

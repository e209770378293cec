#include "src/world/shared_frame_sink.hpp"

#include <algorithm>
#include <utility>

namespace gannet::world {

Result<std::unique_ptr<FrameSink>> SharedFrameSink::create(const std::string& name, int width,
                                                           int height) {
  hal::SharedFramesFormat format;
  format.width = width;
  format.height = height;
  format.format = kFormat;
  format.matrix = kMatrix;
  format.range = kRange;
  auto writer = hal::SharedFramesWriter::create(name, format);
  if (!writer) return writer.error();
  return std::unique_ptr<FrameSink>(new SharedFrameSink(std::move(*writer)));
}

std::optional<FrameSink::Images> SharedFrameSink::begin_frame() {
  const auto images = writer_.begin_frame();
  if (!images) return std::nullopt;
  return Images{images->left, images->right};
}

void SharedFrameSink::publish(const PairTimes& times) {
  const auto& [left, right] = times.of;
  available_ = std::max({available_, left.available, right.available});
  writer_.publish(left.stamp, available_);
}

}  // namespace gannet::world

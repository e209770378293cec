// SharedFrameSink: pairs into shared memory for the daemon's camera kind "simulated". A pair has
// one stamp, and is seen when both images are there. The cameras' drawing thread alone.
#pragma once

#include <memory>
#include <string>

#include "hal/camera/shared_frames.hpp"
#include "platform/base/result.hpp"
#include "src/world/frame_sink.hpp"

namespace gannet::world {

class SharedFrameSink final : public FrameSink {
 public:
  // Error: no shared memory, sides that do not suit.
  static Result<std::unique_ptr<FrameSink>> create(const std::string& name, int width, int height);

  FrameSinkAbilities abilities() const override { return {}; }
  const hal::ImageLayout& layout() const override { return writer_.layout(); }
  std::optional<Images> begin_frame() override;
  void publish(const PairTimes& times) override;

 private:
  explicit SharedFrameSink(hal::SharedFramesWriter writer) : writer_(std::move(writer)) {}
  hal::SharedFramesWriter writer_;
  TimePoint available_ = {};  // of the last pair: never goes back
};

}  // namespace gannet::world

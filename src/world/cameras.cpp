#include "src/world/cameras.hpp"

#include <utility>

namespace gannet::world {

Result<std::unique_ptr<Cameras>> Cameras::create(const Config& config, Renderer renderer,
                                                 std::unique_ptr<FrameSink> sink,
                                                 Parallel& parallel) {
  auto kept = KeptFrames::create(config.keep_folder, config.keep_every);
  if (!kept) return kept.error();
  return std::unique_ptr<Cameras>(
      new Cameras(config, std::move(sink), std::move(*kept), std::move(renderer), parallel));
}

Cameras::Cameras(const Config& config, std::unique_ptr<FrameSink> sink, KeptFrames kept,
                 Renderer renderer, Parallel& parallel)
    : config_(config),
      sink_(std::move(sink)),
      kept_(std::move(kept)),
      renderer_(std::move(renderer)),
      parallel_(parallel),
      random_(config.seed ^ 0xca3e7a) {
  if (config_.in_background) thread_ = std::thread([this] { work(); });
}

Cameras::~Cameras() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Cameras::expose(TimePoint now, double time_s, const Scene& scene,
                     const Transform<World, LeftCamera>& world_from_left) {
  while (next_ <= now) next_ += config_.period;
  ++exposed_;
  const bool dropped = random_.uniform() < drop_share_;  // asked each time, so that runs compare
  const std::lock_guard lock(mutex_);
  if (blind_ || dropped) {
    ++counters_.withheld;
    return;
  }
  if (has_job_) {
    ++counters_.lost;
    return;
  }
  if (!faults_.frozen || job_.number == 0)
    job_ = {now, {}, time_s, scene, world_from_left, exposed_};
  job_.times = faults_.times(job_.capture, now, config_.latency);
  if (config_.in_background) {
    has_job_ = true;
    wake_.notify_one();
  } else {
    ++(draw(job_) ? counters_.frames : counters_.lost);
  }
}

bool Cameras::draw(const Job& job) {
  const auto images = sink_->begin_frame();
  if (!images) return false;
  const Intrinsics& camera = renderer_.rig().left;
  const auto target = [&](std::span<std::uint8_t> bytes) {
    return target_of(sink_->layout(), bytes.data(), FrameSink::kFormat, camera.width, camera.height,
                     FrameSink::kMatrix, FrameSink::kRange);
  };
  renderer_.render(job.scene, job.world_from_left, job.time_s, job.number, parallel_,
                   target(images->left), target(images->right));
  const auto view = [&](std::span<const std::uint8_t> bytes) {
    return hal::view_of(sink_->layout(), bytes.data(), FrameSink::kFormat, camera.width,
                        camera.height, FrameSink::kMatrix, FrameSink::kRange);
  };
  kept_.take(job.number, job.time_s, view(images->left), view(images->right));
  sink_->publish(job.times);
  return true;
}

void Cameras::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return has_job_ || stop_; });
    if (stop_) return;
    lock.unlock();  // job_ is ours while has_job_ stands
    const bool drawn = draw(job_);
    lock.lock();
    ++(drawn ? counters_.frames : counters_.lost);
    has_job_ = false;
  }
}

CameraCounters Cameras::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace gannet::world

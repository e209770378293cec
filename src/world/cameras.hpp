// Cameras: the simulated pair: at each due time renders what both see into a FrameSink, with the
// time of exposure and the later one at which the daemon may see it. Frames can be withheld
// (blind), dropped at random, or be faulty (camera_faults.hpp). World's thread alone; stepped, the
// work is done within the call; live, on a thread of its own, and a pair that comes before the last
// is done is lost, as a slow camera loses it.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "platform/base/parallel.hpp"
#include "platform/base/random.hpp"
#include "platform/base/time.hpp"
#include "src/world/camera_faults.hpp"
#include "src/world/frame_sink.hpp"
#include "src/world/kept_frames.hpp"
#include "src/world/renderer.hpp"

namespace gannet::world {

struct CameraCounters {
  std::uint64_t frames = 0;    // published
  std::uint64_t withheld = 0;  // blind, or dropped by the scenario
  std::uint64_t lost = 0;      // no slot, or the renderer was not done
};

class Cameras {
 public:
  struct Config {
    Duration period = {};
    Duration latency = {};
    bool in_background = false;  // live
    std::uint64_t seed = 1;
    std::string keep_folder = {};  // of pairs that are kept as files (kept_frames.hpp)
    int keep_every = 0;            // 0: none
  };
  // parallel is borrowed. Error: no folder for kept pairs.
  static Result<std::unique_ptr<Cameras>> create(const Config& config, Renderer renderer,
                                                 std::unique_ptr<FrameSink> sink,
                                                 Parallel& parallel);
  ~Cameras();

  // Whether a pair is due by now. Pairs that were missed are not made up for.
  bool due(TimePoint now) const { return now >= next_; }
  // Takes the pair that is due: exposed now, as the world is. time_s is the scenario's.
  void expose(TimePoint now, double time_s, const Scene& scene,
              const Transform<World, LeftCamera>& world_from_left);

  void start(TimePoint first) { next_ = first; }
  void set_blind(bool blind) { blind_ = blind; }
  void set_drop_share(double share) { drop_share_ = share; }
  CameraFaults& faults() { return faults_; }  // from the next exposure on
  FrameSinkAbilities abilities() const { return sink_->abilities(); }
  CameraCounters counters() const;

 private:
  struct Job {
    TimePoint capture;
    PairTimes times;
    double time_s = 0;
    Scene scene;
    Transform<World, LeftCamera> world_from_left;
    std::uint64_t number = 0;
  };
  Cameras(const Config& config, std::unique_ptr<FrameSink> sink, KeptFrames kept, Renderer renderer,
          Parallel& parallel);
  bool draw(const Job& job);
  void work();

  const Config config_;
  std::unique_ptr<FrameSink> sink_;
  KeptFrames kept_;
  Renderer renderer_;
  Parallel& parallel_;
  Random random_;
  TimePoint next_ = {};
  bool blind_ = false;
  double drop_share_ = 0;
  CameraFaults faults_;
  std::uint64_t exposed_ = 0;

  // Live alone: the job is handed over under the lock.
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Job job_;  // stays after it is done: a frozen camera repeats it
  bool has_job_ = false;
  bool stop_ = false;
  CameraCounters counters_;
  std::thread thread_;
};

}  // namespace gannet::world

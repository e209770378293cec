// Simulation: one run of a scenario with a real gannetd. A period of the servo loop is
//   1 events that are due   2 cameras expose, if due   3 the daemon's step (stepped), or waiting
//   4 motors obey and answer   5 what the daemon says   6 record   7 the plant moves on
// Stepped, all of it repeats bit for bit. Live, the daemon's threads run by the same clock beside
// us; a daemon that somebody else runs may die and come back, and the world goes on. Main thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/linux/step_socket.hpp"
#include "src/world/cameras.hpp"
#include "src/world/captures.hpp"
#include "src/world/daemon_process.hpp"
#include "src/world/deeds.hpp"
#include "src/world/ends.hpp"
#include "src/world/line_end.hpp"
#include "src/world/motors.hpp"
#include "src/world/operator_link.hpp"
#include "src/world/plant.hpp"
#include "src/world/run_files.hpp"
#include "src/world/scenario.hpp"
#include "src/world/stage.hpp"
#include "src/world/trace.hpp"

namespace gannet::world {

struct SimulationOptions {
  bool stepped = true;
  std::string gannetd;      // "": somebody else starts it with the run's config
  std::string assets;       // folder of photographs
  std::string folder;       // of the run; "": a temporary one
  std::string control;      // the daemon's control socket; "": in the folder
  std::string keep_folder;  // of frames kept as files (kept_frames.hpp)
  int keep_every = 0;       // 0: none
  EndsConfig ends;          // the kernel's interfaces: live alone
  Duration patience = std::chrono::seconds(30);  // with a daemon that starts, or takes a step
};

struct RunResult {
  Trace trace;
  std::vector<Verdict> verdicts;
  CameraCounters cameras;
  control::Json top;  // the daemon's own figures at the end
  double host_s = 0;  // how long it took
  std::vector<std::string> notes;

  bool passed() const;
};

class Simulation {
 public:
  // Makes pictures, models, devices and files. Error: also an event that the run's cameras cannot
  // play.
  static Result<std::unique_ptr<Simulation>> create(const Scenario& scenario,
                                                    const SimulationOptions& options);
  ~Simulation();

  // Starts the daemon, runs the scenario, ends the daemon. tick is called once a period.
  using Tick = std::function<void(const TraceRow&)>;
  Result<RunResult> run(const Tick& tick);

  const RunFiles& files() const { return files_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  Simulation(const Scenario& scenario, const SimulationOptions& options, RunFiles files);

  // simulation_devices.cpp
  Result<void> make_devices();
  Result<std::vector<std::string>> make_cameras();
  Result<void> make_motors(const hal::DriveConfig& drives);
  Result<void> make_lines();
  Result<void> make_steps();
  Result<void> start_daemon();
  Result<void> patiently(const std::function<Result<void>(Duration)>& attempt);
  Result<Operator> meet_daemon();
  void end_daemon(RunResult& result);

  Result<void> periods(const Tick& tick);
  Result<void> period(TimePoint now);
  void happen(const Event& event, TimePoint now);
  void expose(TimePoint now);
  Result<void> listen();
  void note_turns();
  TraceRow row_at(TimePoint now) const;

  bool is_attached() const { return options_.gannetd.empty(); }
  std::string control_socket() const;
  TimePoint moment(TimePoint due) const;  // live: what the clock says, not what was due
  double seconds_at(TimePoint now) const { return to_seconds(now - start_); }
  Transform<World, Hand> world_from_hand() const;
  Transform<LeftCamera, Target> left_from_target(double time_s) const;

  const Scenario scenario_;
  const SimulationOptions options_;
  RunFiles files_;
  const StereoRig rig_;
  const Duration period_;
  const std::unique_ptr<Plant> plant_;

  std::unique_ptr<Parallel> parallel_;
  std::unique_ptr<Stage> stage_;
  std::unique_ptr<Cameras> cameras_;
  std::unique_ptr<Motors> motors_;  // null: the scenario has no vehicle
  std::unique_ptr<LineEnd> lines_;
  std::optional<linux_os::StepServer> steps_;
  std::optional<DaemonProcess> daemon_;
  std::unique_ptr<OperatorLink> operator_;

  TimePoint start_ = {};
  std::size_t next_event_ = 0;
  Intent intent_;
  HeardEstimate heard_;
  Captures captures_;
  Trace trace_;
  std::vector<std::string> notes_;
};

}  // namespace gannet::world

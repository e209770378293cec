#include "src/world/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "platform/linux/clock.hpp"
#include "platform/linux/periodic.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/world/props.hpp"

namespace gannet::world {
namespace {

constexpr TimePoint kSteppedStart = time_from_ns(1'000'000'000);
constexpr Duration kLiveLook = std::chrono::milliseconds(30);
constexpr const char* kEstopLine = "estop";
constexpr const char* kReleaseLine = "release";
constexpr const char* kLightLine = "light";

hal::LineConfig line_config(const RunFiles& files, const char* name) {
  hal::LineConfig line;
  line.kind = "simulated";
  line.path = files.lines();
  line.name = name;
  return line;
}

std::size_t index_of_drive(const Action& action) {
  return static_cast<std::size_t>(std::max(0.0, action.numbers[0] - 1));
}

}  // namespace

bool RunResult::passed() const {
  return std::all_of(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.passed; });
}

Result<std::unique_ptr<Simulation>> Simulation::create(const Scenario& scenario,
                                                       const SimulationOptions& options) {
  auto files = RunFiles::create(options.folder);
  if (!files) return files.error();
  std::unique_ptr<Simulation> simulation(new Simulation(scenario, options, std::move(*files)));
  const auto made = simulation->make_devices();
  if (!made) return made.error();
  return simulation;
}

Simulation::Simulation(const Scenario& scenario, const SimulationOptions& options, RunFiles files)
    : scenario_(scenario),
      options_(options),
      files_(std::move(files)),
      rig_(scenario.rig()),
      period_(from_seconds(1 / scenario.daemon.servo_hz)),
      plant_(scenario.vehicle.plant) {
  plant_.set_pose(scenario.start_pose());
  const std::vector<double>& current = scenario.vehicle.current_mm_s;
  plant_.set_current(scenario.world_from_reference().rotation *
                     Eigen::Vector3d(current[0], current[1], current[2]) / 1000);
  trace_.period_s = to_seconds(period_);
}

Simulation::~Simulation() = default;

Result<void> Simulation::make_devices() {
  auto models = make_cameras();
  if (!models) return models.error();
  config::DaemonConfig config = daemon_config(scenario_, files_, *models, options_.stepped);
  config.gpio.estop = line_config(files_, kEstopLine);
  config.gpio.release = line_config(files_, kReleaseLine);
  config.gpio.light = line_config(files_, kLightLine);
  const auto written = write_files(scenario_, files_, config);
  if (!written) return written.error();
  const auto lines = make_lines();
  if (!lines) return lines.error();
  const auto motors = make_motors(config.drive);
  if (!motors) return motors.error();
  return make_steps();
}

Result<void> Simulation::make_lines() {
  auto lines = hal::SimulatedLines::create(files_.lines(), {kEstopLine, kReleaseLine, kLightLine});
  if (!lines) return lines.error();
  lines_.emplace(std::move(*lines));
  return {};
}

Result<void> Simulation::make_motors(const hal::DriveConfig& drives) {
  if (scenario_.vehicle.kind == "none") return {};
  auto motors =
      Motors::create(files_.bus(), drives, from_seconds(scenario_.vehicle.drive_delay_ms / 1000),
                     static_cast<std::uint64_t>(scenario_.seed));
  if (!motors) return motors.error();
  motors_ = std::move(*motors);
  trace_.motors = std::min(motors_->count(), kMaxMotors);
  return {};
}

Result<void> Simulation::make_steps() {
  if (!options_.stepped) return {};
  auto steps = linux_os::StepServer::listen(files_.step());
  if (!steps) return steps.error();
  steps_.emplace(std::move(*steps));
  return {};
}

// Returns the models' paths.
Result<std::vector<std::string>> Simulation::make_cameras() {
  const auto seed = static_cast<std::uint64_t>(scenario_.seed);
  auto pictures = gather_pictures(scenario_, options_.assets);
  if (!pictures) return pictures.error();
  notes_ = pictures->notes;
  stage_ = std::make_unique<Stage>(scenario_, pictures->places, seed);

  // Live, the daemon needs the other core.
  auto pool = linux_os::WorkerPool::create(
      "render", std::vector<linux_os::ThreadConfig>(options_.stepped ? 1 : 0));
  if (!pool) return pool.error();
  parallel_ = std::move(*pool);

  RendererConfig renderer_config;
  renderer_config.sensor = scenario_.scene.sensor;
  Renderer renderer(rig_, std::move(pictures->textures), renderer_config, seed);
  auto models = make_models(scenario_, pictures->places, renderer, *parallel_, files_.folder());
  if (!models) return models.error();

  Cameras::Config config;
  config.shared_name = files_.frames();
  config.period = from_seconds(1 / scenario_.camera.fps);
  config.latency = from_seconds(scenario_.camera.latency_ms / 1000);
  config.in_background = !options_.stepped;
  config.seed = seed;
  config.keep_folder = options_.keep_folder;
  config.keep_every = options_.keep_every;
  auto cameras = Cameras::create(config, std::move(renderer), *parallel_);
  if (!cameras) return cameras.error();
  cameras_ = std::move(*cameras);
  return models;
}

Result<void> Simulation::start_daemon() {
  if (options_.gannetd.empty()) return {};
  std::vector<std::string> args = {"-c", files_.config()};
  for (const std::string& setting : scenario_.daemon.settings) {
    args.push_back("--set");
    args.push_back(setting);
  }
  auto daemon = DaemonProcess::start(options_.gannetd, args, files_.log());
  if (!daemon) return daemon.error();
  daemon_.emplace(std::move(*daemon));
  return {};
}

// Asks again and again, so that a daemon that gave up is noticed at once.
Result<void> Simulation::patiently(const std::function<Result<void>(Duration)>& attempt) {
  constexpr Duration kSlice = std::chrono::milliseconds(100);
  Result<void> done;
  for (Duration waited{}; waited < options_.patience; waited += kSlice) {
    done = attempt(kSlice);
    if (done) return done;
    if (daemon_ && !daemon_->running())
      return Error{options_.gannetd + " ended with exit code " +
                   std::to_string(daemon_->exit_code()) + " before the run began"};
  }
  return done;
}

Result<void> Simulation::meet_daemon() {
  lines_->write(lines_->find(kEstopLine), hal::Level::kLow, {});
  const auto started = start_daemon();
  if (!started) return started.error();
  if (steps_) {
    const auto met = patiently([&](Duration slice) { return steps_->wait_for_daemon(slice); });
    if (!met) return met.error();
  }
  return patiently([&](Duration slice) -> Result<void> {
    auto person = Operator::connect(files_.control(), slice);
    if (!person) return person.error();
    operator_.emplace(std::move(*person));
    return {};
  });
}

Result<RunResult> Simulation::run(const Tick& tick) {
  const auto begin = std::chrono::steady_clock::now();
  RunResult result;
  auto done = meet_daemon();
  if (done) done = periods(tick);
  if (!done) return done.error();
  if (auto top = operator_->top()) result.top = std::move(*top);
  end_daemon(result);
  result.trace = std::move(trace_);
  for (const Check& check : scenario_.checks) result.verdicts.push_back(judge(check, result.trace));
  std::rotate(result.verdicts.begin(),
              result.verdicts.end() - static_cast<std::ptrdiff_t>(scenario_.checks.size()),
              result.verdicts.end());
  result.cameras = cameras_->counters();
  result.notes = notes_;
  result.host_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Result<void> Simulation::periods(const Tick& tick) {
  const auto count = static_cast<long>(std::lround(scenario_.duration_s / to_seconds(period_)));
  start_ = options_.stepped ? kSteppedStart : linux_os::monotonic_now() + period_;
  cameras_->start(start_);
  linux_os::Periodic clock(start_, period_);
  for (long k = 0; k <= count; ++k) {
    TimePoint now = start_ + k * period_;
    if (!options_.stepped) {
      const auto wake = clock.wait();
      k += static_cast<long>(wake.missed);
      for (std::int64_t i = 0; i < wake.missed; ++i) plant_.advance(to_seconds(period_));
      now = wake.due;
    }
    const auto done = period(now);
    if (!done) return done;
    tick(trace_.rows.back());
  }
  return {};
}

Result<void> Simulation::period(TimePoint now) {
  while (next_event_ < scenario_.events.size() &&
         scenario_.events[next_event_].at_s <= seconds_at(now) + 1e-9) {
    const auto happened = happen(scenario_.events[next_event_++], now);
    if (!happened) return happened;
  }
  if (cameras_->due(now)) expose(now);
  if (steps_) {
    const auto done = steps_->step(now, options_.patience);
    if (!done) return done;
  }
  if (motors_) motors_->step(now, plant_);
  const auto heard = listen(now);
  if (!heard) return heard;
  trace_.rows.push_back(row_at(now));
  if (motors_) plant_.advance(to_seconds(period_));
  return {};
}

Result<void> Simulation::happen(const Event& event, TimePoint now) {
  std::string text = event.action.text;
  if (event.action.is_operator_command()) {
    const auto told = operator_->command(event.action);
    // A refusal is part of the story; checks say whether it should have been.
    if (!told) {
      notes_.push_back(told.error().text);
      text += ": refused";
    }
  }
  act(event.action, now);
  trace_.marks.push_back({seconds_at(now), text});
  return {};
}

void Simulation::act(const Action& action, TimePoint now) {
  const auto set_estop = [&](hal::Level level) {
    estop_ = level != hal::Level::kLow;
    lines_->write(lines_->find(kEstopLine), level, now);
  };
  const auto faults = [&](auto&& change) {
    const auto drive = index_of_drive(action);
    if (motors_ && static_cast<int>(drive) < motors_->count())
      change(motors_->faults(static_cast<int>(drive)), plant_.thrusters()[drive]);
  };
  const auto vector = [&]() -> Eigen::Vector3d {
    return Eigen::Vector3d(action.numbers[0], action.numbers[1], action.numbers[2]) / 1000;
  };
  switch (action.verb) {
    case Verb::kPressEstop:
      return set_estop(hal::Level::kHigh);
    case Verb::kReleaseEstop:
      return set_estop(hal::Level::kLow);
    case Verb::kCutEstop:
      return set_estop(hal::Level::kUnknown);
    case Verb::kTarget:
      if (action.name != "none") target_ = stage_->find(action.name);
      return;
    case Verb::kGoal:
      goal_m_ = vector();
      return;
    case Verb::kBlind:
      return cameras_->set_blind(true);
    case Verb::kSee:
      cameras_->set_drop_share(0);
      return cameras_->set_blind(false);
    case Verb::kDrop:
      return cameras_->set_drop_share(action.numbers[0]);
    case Verb::kOcclude:
      return stage_->cover(stage_->find(action.name), true);
    case Verb::kUncover:
      return stage_->cover(stage_->find(action.name), false);
    case Verb::kSilenceDrive:
      return faults([](MotorFaults& node, Thruster&) { node.silent = true; });
    case Verb::kFaultDrive:
      return faults([](MotorFaults& node, Thruster&) { node.faulty = true; });
    case Verb::kJamDrive:
      return faults([](MotorFaults&, Thruster& thruster) { thruster.jam(true); });
    case Verb::kMendDrive:
      return faults([](MotorFaults& node, Thruster& thruster) {
        node = {};
        thruster.jam(false);
      });
    case Verb::kLight:
      return stage_->set_light(action.numbers[0]);
    case Verb::kCurrent:
      return plant_.set_current(scenario_.world_from_reference().rotation * vector());
    case Verb::kArm:
    case Verb::kDisarm:
    case Verb::kReset:
    case Verb::kStop:
      return;  // the daemon's business alone
  }
}

Transform<World, Hand> Simulation::world_from_hand() const {
  return plant_.pose() * *rig_.body_from_hand;
}

Transform<LeftCamera, Target> Simulation::left_from_target(double time_s) const {
  return rig_.hand_from_left.inverse() * world_from_hand().inverse() *
         stage_->pose(target_, time_s);
}

void Simulation::expose(TimePoint now) {
  const double time_s = seconds_at(now);
  captures_[to_ns(now)] = left_from_target(time_s);
  if (captures_.size() > 200) captures_.erase(captures_.begin());
  cameras_->expose(now, time_s, stage_->scene(time_s), world_from_hand() * rig_.hand_from_left);
}

Result<void> Simulation::listen(TimePoint now) {
  if (!options_.stepped && now - last_look_ < kLiveLook) return {};
  last_look_ = now;
  auto heard = operator_->look(start_);
  if (!heard) return heard.error();
  heard_ = std::move(*heard);
  return {};
}

TraceRow Simulation::row_at(TimePoint now) const {
  TraceRow row;
  row.time_s = seconds_at(now);
  row.vehicle = plant_.pose();
  row.target = world_from_hand().inverse() * stage_->pose(target_, row.time_s);
  row.in_view = stage_->in_view(target_, row.time_s, rig_, world_from_hand());
  row.error_m = row.target.translation - goal_m_;
  row.error_rad = rotation_vector_from_quaternion(row.target.rotation).y();
  if (motors_) {
    const auto throttles = motors_->throttles();
    std::copy_n(throttles.begin(), trace_.motors, row.throttle.begin());
    row.armed = motors_->armed();
  }
  row.estop = estop_;
  row.release = lines_->read(lines_->find(kReleaseLine)) == hal::Level::kHigh;
  row.heard = heard_;
  const auto capture = captures_.find(to_ns(start_ + from_seconds(heard_.capture_s)));
  if (capture != captures_.end()) row.at_capture = capture->second;
  return row;
}

void Simulation::end_daemon(RunResult& result) {
  operator_.reset();
  steps_.reset();  // a stepped daemon ends with its world
  if (!daemon_) return;
  const int code = daemon_->stop(std::chrono::seconds(5));
  result.verdicts.push_back(
      {"gannetd ends in order", "exit code " + std::to_string(code), code == 0});
}

}  // namespace gannet::world

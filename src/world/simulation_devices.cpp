// How a run's devices, files and daemon come to be and go: the start-up half of Simulation.
#include <algorithm>
#include <chrono>

#include "platform/linux/worker_pool.hpp"
#include "src/world/props.hpp"
#include "src/world/simulation.hpp"

namespace gannet::world {

Result<void> Simulation::make_devices() {
  if (options_.stepped && options_.ends.any_real())
    return Error{"the kernel's interfaces have their own time: they need --live"};
  auto models = make_cameras();
  if (!models) return models.error();
  const auto playable = check_events(scenario_, cameras_->abilities());
  if (!playable) return playable;
  const auto lines = make_lines();
  if (!lines) return lines.error();
  config::DaemonConfig config = daemon_config(scenario_, files_, *models, options_.stepped);
  config.control.socket = control_socket();
  configure_ends(options_.ends, scenario_, config);
  configure_lines(*lines_, line_end_of(options_.ends, scenario_, files_), config.gpio);
  const auto written = write_files(scenario_, files_, config);
  if (!written) return written.error();
  if (is_attached()) {
    const auto settings = write_settings(scenario_, files_);
    if (!settings) return settings.error();
  }
  const auto motors = make_motors(config.drive);
  if (!motors) return motors.error();
  return make_steps();
}

std::string Simulation::control_socket() const {
  return options_.control.empty() ? files_.control() : options_.control;
}

Result<void> Simulation::make_lines() {
  auto lines = make_line_end(line_end_of(options_.ends, scenario_, files_));
  if (!lines) return lines.error();
  lines_ = std::move(*lines);
  return {};
}

Result<void> Simulation::make_motors(const hal::DriveConfig& drives) {
  if (scenario_.vehicle.kind == "none") return {};
  auto bus = CanEnd::create(can_end_of(options_.ends, files_), {});
  if (!bus) return bus.error();
  auto motors =
      Motors::create(std::move(*bus), drives, from_seconds(scenario_.vehicle.drive_delay_ms / 1000),
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
  if (scenario_.scene.detail == "plain") {
    renderer_config.sensor.noise = false;
    renderer_config.blur_x_px = renderer_config.blur_y_px = 0;
  }
  Renderer renderer(rig_, std::move(pictures->textures), renderer_config, seed);
  auto models = make_models(scenario_, pictures->places, renderer, *parallel_, files_.folder());
  if (!models) return models.error();

  Cameras::Config config;
  config.period = from_seconds(1 / scenario_.camera.fps);
  config.latency = from_seconds(scenario_.camera.latency_ms / 1000);
  config.in_background = !options_.stepped;
  config.seed = seed;
  config.keep_folder = options_.keep_folder;
  config.keep_every = options_.keep_every;
  auto sink = make_frame_sink(options_.ends, scenario_, files_);
  if (!sink) return sink.error();
  auto cameras = Cameras::create(config, std::move(renderer), std::move(*sink), *parallel_);
  if (!cameras) return cameras.error();
  cameras_ = std::move(*cameras);
  return models;
}

Result<void> Simulation::start_daemon() {
  if (is_attached()) return {};
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

Result<Operator> Simulation::meet_daemon() {
  lines_->press(Button::kReleased, {});
  const auto started = start_daemon();
  if (!started) return started.error();
  if (steps_) {
    const auto met = patiently([&](Duration slice) { return steps_->wait_for_daemon(slice); });
    if (!met) return met.error();
  }
  std::optional<Operator> person;
  const auto met = patiently([&](Duration slice) -> Result<void> {
    auto connected = Operator::connect(control_socket(), slice);
    if (!connected) return connected.error();
    person.emplace(std::move(*connected));
    return {};
  });
  if (!met) return met.error();
  return std::move(*person);
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

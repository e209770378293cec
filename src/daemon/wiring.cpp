#include "src/daemon/wiring.hpp"

#include <poll.h>

#include <utility>
#include <vector>

#include "platform/base/log.hpp"
#include "platform/linux/periodic.hpp"
#include "platform/linux/sd_notify.hpp"
#include "src/telemetry/event_codes.hpp"

namespace gannet::daemon {

using std::chrono::milliseconds;
using std::chrono::seconds;
using telemetry::make_event;

namespace {

// The longest time for which a loop does not look whether to stop.
constexpr Duration kNap = milliseconds(50);

void sleep_for(Duration d) {
  const timespec t = {0, static_cast<long>(d.count())};
  nanosleep(&t, nullptr);
}

std::vector<linux_os::ThreadConfig> helpers(const config::RealtimeConfig& config) {
  std::vector<linux_os::ThreadConfig> helpers;
  for (const int core : config.worker_cores) helpers.push_back({core, config.worker_priority});
  return helpers;
}

}  // namespace

Daemon::Daemon(config::LoadedConfig loaded, Parts parts)
    : loaded_(std::move(loaded)),
      parts_(std::move(parts)),
      clock_(is_stepped() ? static_cast<const linux_os::Clock*>(&stepped_clock_) : &live_clock_),
      period_(from_seconds(1 / loaded_.config.realtime.servo_rate_hz)) {}

Result<std::unique_ptr<Daemon>> Daemon::create(config::LoadedConfig loaded, Parts parts) {
  std::unique_ptr<Daemon> daemon(new Daemon(std::move(loaded), std::move(parts)));
  if (auto opened = daemon->open(); !opened) return opened.error();
  return daemon;
}

Daemon::~Daemon() { stop(); }

// The control socket and the claim on the bus first: a second daemon must not touch a device of the
// first one.
Result<void> Daemon::open() {
  const config::DaemonConfig& config = loaded_.config;
  if (!config.control.socket.empty()) {
    auto server = control::Server::listen(config.control.socket, config.control.group);
    if (!server) return server.error();
    server_ = std::move(*server);
  }
  if (config.vehicle.kind != "none" && config.can.kind == "socketcan") {
    auto claim = claim_interface(config.can.interface);
    if (!claim) return claim.error();
    bus_claim_ = std::move(*claim);
  }
  if (is_stepped()) {
    auto steps = linux_os::StepClient::connect(config.clock.step_socket, seconds(10));
    if (!steps) return steps.error();
    steps_.emplace(std::move(*steps));
  }
  auto devices = open_devices(loaded_, parts_.drives.get(), clock_->now());
  if (!devices) return devices.error();
  devices_ = std::move(*devices);
  auto archive = ArchiveLoop::create(config.frames, &report_lines_.archive_events);
  if (!archive) return archive.error();
  archive_ = std::move(*archive);
  auto workers = linux_os::WorkerPool::create("gannet-worker", helpers(config.realtime));
  if (!workers) return workers.error();
  workers_ = std::move(*workers);
  make_loops();
  make_commands();
  return {};
}

void Daemon::make_loops() {
  const config::DaemonConfig& config = loaded_.config;
  capture_ = std::make_unique<CaptureLoop>(
      CaptureLoop::Links{devices_.camera.get(), &to_vision_, &report_lines_.capture,
                         &report_lines_.capture_events, &facts_},
      loaded_.rig.left.time_offset);
  vision_ = std::make_unique<VisionLoop>(
      VisionLoop::Links{parts_.tracker.get(), workers_.get(), &to_vision_,
                        archive_ ? &archive_->line() : nullptr, &command_lines_.to_vision,
                        &to_servo_, &report_lines_.vision, &report_lines_.vision_events, &facts_},
      !is_stepped(), milliseconds(100));
  servo_ = std::make_unique<ServoLoop>(
      ServoLoop::Links{parts_.vehicle.get(), parts_.law.get(), devices_.bus.get(),
                       parts_.drives.get(), devices_.estop.get(), devices_.light.get(), &to_servo_,
                       &command_lines_.to_servo, &command_lines_.params, &report_lines_.servo,
                       &report_lines_.servo_events, &facts_, devices_.estop_second.get()},
      loaded_.rig, config.safety, config.filter, config.servo.params, period_);
}

void Daemon::make_commands() {
  ControlCommands::Setting setting;
  setting.loaded = &loaded_;
  setting.models = parts_.model_names;
  setting.symmetries = parts_.model_symmetries;
  setting.image_width = devices_.camera->width();
  setting.image_height = devices_.camera->height();
  setting.server = server_ ? &server_->counters() : nullptr;
  setting.now = [this] { return clock_->now(); };
  if (!is_stepped()) setting.pause = [] { sleep_for(milliseconds(1)); };
  commands_ = std::make_unique<ControlCommands>(std::move(setting), &reports_, &command_lines_);
}

int Daemon::run(int signal_fd) {
  if (!is_stepped()) {
    if (auto started = start_threads(); !started) {
      log(Severity::kError, started.error().text);
      return kExitDevice;
    }
  }
  const std::string note = linux_os::rights_note();
  if (!note.empty()) {
    log(Severity::kWarning, note);
    reports_.add_event(make_event(telemetry::kRightsMissing, clock_->now()));
  }
  warn_of_no_estop();
  reports_.add_event(make_event(telemetry::kStarted, clock_->now()));
  linux_os::sd_notify("READY=1");
  while (wait_and_serve(signal_fd)) feed_watchdog();
  linux_os::sd_notify("STOPPING=1");
  reports_.add_event(make_event(telemetry::kStopping, clock_->now()));
  stop();
  reports_.refresh();
  return kExitStopped;
}

void Daemon::warn_of_no_estop() const {
  const config::DaemonConfig& config = loaded_.config;
  if (config.vehicle.kind == "none" || config.gpio.estop.kind != "none") return;
  log(Severity::kWarning,
      config.safety.accept_no_estop
          ? "safety.accept_no_estop: this vehicle has no emergency stop line; nothing but the "
            "programs can stop it"
          : "gpio.estop.kind is \"none\": arming will be refused; configure the emergency stop, or "
            "set safety.accept_no_estop = true");
}

Result<void> Daemon::start_threads() {
  const config::RealtimeConfig& config = loaded_.config.realtime;
  if (config.lock_memory) linux_os::lock_memory();
  struct Plan {
    linux_os::Thread* thread;
    const char* name;
    linux_os::ThreadConfig config;
    void (Daemon::*body)();
  };
  const Plan plans[] = {{&servo_thread_, "gannet-servo", config.servo, &Daemon::run_servo},
                        {&vision_thread_, "gannet-vision", config.vision, &Daemon::run_vision},
                        {&capture_thread_, "gannet-capture", config.capture, &Daemon::run_capture},
                        {&archive_thread_, "gannet-archive", {}, &Daemon::run_archive}};
  for (const Plan& plan : plans) {
    if (plan.thread == &archive_thread_ && !archive_) continue;
    auto thread = linux_os::Thread::start(plan.name, plan.config,
                                          [this, body = plan.body] { (this->*body)(); });
    if (!thread) return thread.error();
    *plan.thread = std::move(*thread);
  }
  return {};
}

void Daemon::run_capture() {
  while (!facts_.stop) {
    const TimePoint begin = clock_->now();
    capture_->step(begin, kNap);
    // A camera that is gone answers at once: it is asked again after a while.
    const bool had_frame = facts_.last_frame_ns.load(std::memory_order_relaxed) >= to_ns(begin);
    if (!had_frame && clock_->now() - begin < milliseconds(1)) sleep_for(milliseconds(5));
  }
}

void Daemon::run_vision() {
  while (!facts_.stop) {
    to_vision_.wait(clock_->now() + kNap);
    vision_->step(clock_->now());
  }
}

void Daemon::run_servo() {
  linux_os::Periodic periodic(clock_->now() + period_, period_);
  while (!facts_.stop) {
    const auto wake = periodic.wait();
    servo_->step(clock_->now(), wake.missed, wake.late);
  }
}

void Daemon::run_archive() {
  while (!facts_.stop) {
    archive_->line().wait(clock_->now() + kNap);
    archive_->step(clock_->now());
  }
}

void Daemon::run_stepped_once() {
  const TimePoint now = clock_->now();
  // A camera may have several pairs due; each counts as if it had been waited for.
  while (capture_->step(now, Duration{}) == hal::CaptureStatus::kFrame) {
  }
  vision_->step(now);
  if (archive_) archive_->step(now);
  servo_->step(now);
}

void Daemon::step_to(TimePoint t) {
  if (!next_servo_) next_servo_ = t;  // time begins with the first step
  while (*next_servo_ <= t) {
    stepped_clock_.set(*next_servo_);
    run_stepped_once();
    *next_servo_ += period_;
  }
  stepped_clock_.set(t);
}

// False: it is time to stop.
bool Daemon::wait_and_serve(int signal_fd) {
  std::vector<pollfd> fds = {{signal_fd, POLLIN, 0}};
  if (steps_) fds.push_back({steps_->fd(), POLLIN, 0});
  if (server_) server_->add_poll(fds);
  poll(fds.data(), fds.size(), 100);
  if ((fds[0].revents & POLLIN) != 0) return false;
  // Clients before the step: what was asked before it holds in it.
  if (server_) {
    server_->serve([this](const control::Request& r) { return commands_->handle(r); });
  }
  reports_.refresh();
  // Before the step: what a mission asks for now holds in it.
  commands_->advance();
  return !steps_ || take_step();
}

bool Daemon::take_step() {
  TimePoint t;
  switch (steps_->receive(t, Duration{})) {
    case linux_os::StepClient::Status::kStep:
      step_to(t);
      reports_.refresh();
      return steps_->answer_done(t);
    case linux_os::StepClient::Status::kMalformed:
      log(Severity::kWarning, "clock.step_socket: a message that is no step is ignored");
      return true;
    case linux_os::StepClient::Status::kNothing:
      return true;
    case linux_os::StepClient::Status::kGone:
      log(Severity::kNotice, "the world of the stepped clock has gone");
      return false;
  }
  return false;
}

void Daemon::feed_watchdog() {
  const WatchdogFeed::Cycles cycles = {facts_.capture_cycles, facts_.vision_cycles,
                                       facts_.servo_cycles};
  switch (feed_.look(linux_os::monotonic_now(), cycles)) {
    case WatchdogFeed::Say::kAlive:
      linux_os::sd_notify("WATCHDOG=1");
      return;
    case WatchdogFeed::Say::kStuck:
      log(Severity::kError, "these loops stand still: " + feed_.standing_still() +
                                "; if that lasts, the service manager will restart gannetd");
      return;
    case WatchdogFeed::Say::kNothing:
      return;
  }
}

void Daemon::stop() {
  if (facts_.stop.exchange(true)) return;
  to_vision_.wake();
  if (archive_) archive_->line().wake();
  // The motors first: the others may be in a driver or on a slow disk for long.
  servo_thread_.join();
  if (servo_) servo_->shut_down(clock_->now());
  for (auto* thread : {&capture_thread_, &vision_thread_, &archive_thread_}) thread->join();
  if (archive_) archive_->step(clock_->now());
}

}  // namespace gannet::daemon

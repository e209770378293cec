// Daemon: all loops, what they hand to each other, and the threads that run them.
//
//   capture ══frames══▶ vision + workers ══frames══▶ archive
//                       vision ──targets──▶ servo ◀──commands, params── main (control socket)
//   every loop ──reports, events──▶ main
//
// Live each loop has its thread; stepped the main thread runs what is due at each step of the
// world, always in the same order: capture, vision, archive, servo. Main thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "platform/base/result.hpp"
#include "platform/linux/clock.hpp"
#include "platform/linux/sd_notify.hpp"
#include "platform/linux/step_socket.hpp"
#include "platform/linux/worker_pool.hpp"
#include "src/control/server.hpp"
#include "src/daemon/archive_loop.hpp"
#include "src/daemon/capture_loop.hpp"
#include "src/daemon/claimed_interface.hpp"
#include "src/daemon/control_commands.hpp"
#include "src/daemon/parts.hpp"
#include "src/daemon/reports.hpp"
#include "src/daemon/servo_loop.hpp"
#include "src/daemon/vision_loop.hpp"
#include "src/daemon/watchdog_feed.hpp"

namespace gannet::daemon {

inline constexpr int kExitStopped = 0;
inline constexpr int kExitBadConfig = 2;
inline constexpr int kExitDevice = 3;

class Daemon {
 public:
  // Parts are made from the same config. Error: a device, a socket or a thread failed.
  static Result<std::unique_ptr<Daemon>> create(config::LoadedConfig loaded, Parts parts);
  ~Daemon();

  // Runs until SIGTERM, SIGINT or the end of the stepped world. signal_fd tells the signals.
  int run(int signal_fd);

  // One moment of stepped time: everything due up to t.
  void step_to(TimePoint t);

 private:
  Daemon(config::LoadedConfig loaded, Parts parts);
  Result<void> open();
  void make_loops();
  void make_commands();
  Result<void> start_threads();
  void warn_of_no_estop() const;
  void run_capture();
  void run_vision();
  void run_servo();
  void run_archive();
  void run_stepped_once();
  bool wait_and_serve(int signal_fd);
  bool take_step();
  void feed_watchdog();
  void stop();
  bool is_stepped() const { return loaded_.config.clock.kind == "stepped"; }

  const config::LoadedConfig loaded_;
  Parts parts_;
  std::unique_ptr<control::Server> server_;
  linux_os::UnixListener bus_claim_;  // of a real bus
  std::optional<linux_os::StepClient> steps_;
  linux_os::LiveClock live_clock_;
  linux_os::SteppedClock stepped_clock_;
  const linux_os::Clock* clock_;
  // Devices before the lines: the leases in the lines are the camera's and go home first.
  Devices devices_;
  ReportLines report_lines_;
  CommandLines command_lines_;
  SharedFacts facts_;
  FrameLine to_vision_{8};
  SpscRing<SeenTarget> to_servo_{64};
  Reports reports_{&report_lines_};
  std::unique_ptr<linux_os::WorkerPool> workers_;
  std::unique_ptr<ArchiveLoop> archive_;
  std::unique_ptr<CaptureLoop> capture_;
  std::unique_ptr<VisionLoop> vision_;
  std::unique_ptr<ServoLoop> servo_;
  std::unique_ptr<ControlCommands> commands_;
  const Duration period_;
  std::optional<TimePoint> next_servo_;  // stepped
  WatchdogFeed feed_{linux_os::sd_watchdog()};
  linux_os::Thread capture_thread_, vision_thread_, servo_thread_, archive_thread_;
};

}  // namespace gannet::daemon

// gannetd: reads the config, makes the parts, runs. Everything else is in wiring.cpp.
#include <signal.h>
#include <sys/signalfd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/base/command_line.hpp"
#include "platform/base/log.hpp"
#include "platform/linux/fd.hpp"
#include "src/daemon/wiring.hpp"

namespace gannet::daemon {
namespace {

constexpr const char* kDefaultFile = "/etc/gannet/gannet.toml";

const Command kCommand = {
    .name = "gannetd",
    .summary = "stereo visual servoing daemon",
    .description =
        "Recognises a target in the images of two cameras, follows it with its pose, and steers a "
        "vehicle by it over a CAN bus. It starts in standby and never arms by itself: a person "
        "does, with gannet(1).\n\nSIGTERM and SIGINT stop it in order: the motors are commanded "
        "to stop, every device is closed.\n\nAs a service (gannetd.service) it tells systemd when "
        "it is ready, and feeds the watchdog only while the loops of capture, vision and servo "
        "all move. After a crash it comes up in standby. A second one is refused the control "
        "socket and the CAN interface of the first.",
    .options = {{.name = "config",
                 .letter = 'c',
                 .value = "FILE",
                 .help = std::string("Configuration; default ") + kDefaultFile + "."},
                {.name = "check",
                 .value = "FILE",
                 .help = "Check this configuration and all files that it names, and end."},
                {.name = "print-default-config",
                 .kind = ArgumentKind::kFlag,
                 .help = "Print the built-in values as a commented file, and end."},
                {.name = "set",
                 .value = "ROOM.KEY=VALUE",
                 .repeats = true,
                 .help = "Set one value; the last word over all files."}},
    .example = "gannetd -c gannet.toml --set servo.position_gain=0.8",
    .exit_codes = "0  stopped\n2  bad configuration or command line\n3  a device failed at start",
    .see_also = "gannet(1), gannet.toml(5)",
    .section = 8};

int fail(int exit_code, const std::string& text) {
  log(Severity::kError, text);
  return exit_code;
}

std::string file_of(const Arguments& arguments) {
  if (arguments.given("check")) return arguments.text("check");
  if (arguments.given("config")) return arguments.text("config");
  return std::filesystem::exists(kDefaultFile) ? kDefaultFile : "";
}

// Blocked before any thread starts, so that all inherit it; told by the descriptor alone.
linux_os::Fd block_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  return linux_os::Fd(signalfd(-1, &set, SFD_CLOEXEC));
}

int run(const Arguments& arguments) {
  auto loaded = config::load_daemon_config({file_of(arguments), arguments.texts("set")});
  if (!loaded) return fail(kExitBadConfig, loaded.error().text);
  auto parts = make_parts(*loaded);
  if (!parts) return fail(kExitBadConfig, parts.error().text);
  if (arguments.given("check")) {
    const auto recording = check_recording(*loaded);
    return recording ? kExitStopped : fail(kExitBadConfig, recording.error().text);
  }
  const linux_os::Fd signals = block_signals();
  auto daemon = Daemon::create(std::move(*loaded), std::move(*parts));
  if (!daemon) return fail(kExitDevice, daemon.error().text);
  return (*daemon)->run(signals.get());
}

int main(std::vector<std::string> args) {
  Arguments arguments;
  if (const auto code = begin_command(kCommand, args, arguments)) return *code;
  if (arguments.flag("print-default-config")) {
    std::fputs(config::print_default().c_str(), stdout);
    return kExitStopped;
  }
  return run(arguments);
}

}  // namespace
}  // namespace gannet::daemon

int main(int argc, char** argv) { return gannet::daemon::main({argv + 1, argv + argc}); }

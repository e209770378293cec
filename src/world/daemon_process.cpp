#include "src/world/daemon_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <thread>
#include <utility>

#include "platform/linux/fd.hpp"

namespace gannet::world {
namespace {

// In the child: never returns. The errno of a failed exec goes to the parent.
[[noreturn]] void become(char* const* arguments, int log, int report, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(127);  // it died before we asked
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execvp(arguments[0], arguments);
  const int error = errno;
  if (write(report, &error, sizeof error) < 0) _exit(126);
  _exit(127);
}

}  // namespace

Result<DaemonProcess> DaemonProcess::start(const std::string& program,
                                           const std::vector<std::string>& args,
                                           const std::string& log_path) {
  const linux_os::Fd log(
      open(log_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_APPEND, 0644));
  if (!log.valid()) return linux_os::system_error(log_path, errno);
  int pipe_fds[2];
  if (pipe2(pipe_fds, O_CLOEXEC) != 0) return linux_os::system_error("pipe", errno);
  const linux_os::Fd read_end(pipe_fds[0]);
  linux_os::Fd write_end(pipe_fds[1]);

  std::vector<std::string> words = {program};
  words.insert(words.end(), args.begin(), args.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) return linux_os::system_error("fork", errno);
  if (child == 0) become(arguments.data(), log.get(), write_end.get(), parent);
  write_end.reset();
  DaemonProcess process;
  process.pid_ = child;
  int error = 0;  // nothing comes when exec succeeded: it closed the pipe
  if (read(read_end.get(), &error, sizeof error) == sizeof error)
    return linux_os::system_error(program, error);
  return process;
}

DaemonProcess::DaemonProcess(DaemonProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), ended_(other.ended_), exit_code_(other.exit_code_) {}

DaemonProcess& DaemonProcess::operator=(DaemonProcess&& other) noexcept {
  if (this != &other) {
    if (running()) stop({});
    pid_ = std::exchange(other.pid_, -1);
    ended_ = other.ended_;
    exit_code_ = other.exit_code_;
  }
  return *this;
}

DaemonProcess::~DaemonProcess() {
  if (running()) stop({});
}

bool DaemonProcess::reap(bool wait) {
  if (pid_ < 0 || ended_) return true;
  int status = 0;
  if (waitpid(pid_, &status, wait ? 0 : WNOHANG) != pid_) return false;
  ended_ = true;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

bool DaemonProcess::running() { return !reap(false); }

int DaemonProcess::stop(Duration timeout) {
  if (!running()) return exit_code_;
  kill(pid_, SIGTERM);
  constexpr auto kPause = std::chrono::milliseconds(5);
  for (Duration waited{}; waited < timeout; waited += kPause) {
    if (!running()) return exit_code_;
    std::this_thread::sleep_for(kPause);
  }
  if (!running()) return exit_code_;
  kill(pid_, SIGKILL);
  reap(true);
  return exit_code_;
}

std::string gannetd_beside(const std::string& program) {
  const std::size_t slash = program.rfind('/');
  if (slash == std::string::npos) return "gannetd";
  const std::string beside = program.substr(0, slash + 1) + "gannetd";
  return access(beside.c_str(), X_OK) == 0 ? beside : "gannetd";
}

}  // namespace gannet::world

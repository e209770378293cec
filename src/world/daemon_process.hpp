// DaemonProcess: gannetd as our child: started with its output in a log file, told to stop,
// waited for. It dies with us, however we die. World's main thread.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"

namespace gannet::world {

class DaemonProcess {
 public:
  // Error: the program cannot be run.
  static Result<DaemonProcess> start(const std::string& program,
                                     const std::vector<std::string>& args,
                                     const std::string& log_path);
  DaemonProcess(DaemonProcess&& other) noexcept;
  DaemonProcess& operator=(DaemonProcess&& other) noexcept;
  ~DaemonProcess();  // kills what still runs

  bool running();
  // Asks it to end and waits; after the time-out it is killed. Returns its exit code, 128 + the
  // signal that ended it.
  int stop(Duration timeout);
  int exit_code() const { return exit_code_; }  // of one that has ended
  pid_t pid() const { return pid_; }

 private:
  DaemonProcess() = default;
  bool reap(bool wait);
  pid_t pid_ = -1;
  bool ended_ = false;
  int exit_code_ = -1;
};

// gannetd beside the running program, else from the search path.
std::string gannetd_beside(const std::string& program);

}  // namespace gannet::world

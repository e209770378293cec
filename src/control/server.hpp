// Server: the daemon's end of the control socket. It never blocks and holds a bounded amount for
// each client: a line longer than kMaxLine is refused, one who does not read its answers is
// dropped. Junk is answered with an error and counted; it harms nobody else.
// Who may connect is the business of the socket file's mode and group. Control thread.
#pragma once

#include <poll.h>

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "platform/linux/unix_socket.hpp"
#include "src/control/line_buffer.hpp"
#include "src/control/protocol.hpp"

namespace gannet::control {

struct ServerCounters {
  std::uint64_t connections = 0;
  std::uint64_t requests = 0;
  std::uint64_t junk = 0;     // lines that were no request
  std::uint64_t dropped = 0;  // clients that were too many or did not read
};

class Server {
 public:
  using Handler = std::function<Answer(const Request&)>;

  static constexpr int kMaxClients = 16;
  static constexpr std::size_t kMaxPending = 4 * 1024 * 1024;  // bytes of answers unread

  // group: whose members may connect beside our own user; empty: nobody else.
  static Result<std::unique_ptr<Server>> listen(const std::string& path, const std::string& group);

  // What to wait for.
  void add_poll(std::vector<pollfd>& fds) const;
  // Takes newcomers, answers what has come, sends what could not be sent before.
  void serve(const Handler& handler);

  int clients() const { return static_cast<int>(clients_.size()); }
  const ServerCounters& counters() const { return counters_; }

 private:
  Server() = default;
  struct Client {
    linux_os::UnixSocket socket;
    LineBuffer lines{kMaxLine};
    std::string pending = {};
    bool gone = false;
  };
  void accept_newcomers();
  void receive(Client& client, const Handler& handler);
  void answer(Client& client, const std::string& line, const Handler& handler);
  void flush(Client& client);

  linux_os::UnixListener listener_;
  std::list<Client> clients_;
  ServerCounters counters_;
};

}  // namespace gannet::control

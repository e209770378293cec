// Client: a program's end of the control socket: connect, ask, take the answer. Blocking with a
// time-out. One thread.
#pragma once

#include <string>
#include <variant>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "platform/linux/unix_socket.hpp"
#include "src/control/line_buffer.hpp"
#include "src/control/protocol.hpp"

namespace gannet::control {

class Client {
 public:
  // Error: nobody serves the socket, or we may not connect.
  static Result<Client> connect(const std::string& path);

  // The method's result. Error: "what (code)" of a failure that the daemon told, no answer within
  // the time-out, or an answer that is none. last_failure() has the daemon's own words.
  Result<Json> call(const std::string& method, const Json& params = Json::object(),
                    Duration timeout = std::chrono::seconds(5));

  // The newest call's "error" object; empty if the daemon told none.
  const Json& last_failure() const { return last_failure_; }

 private:
  Result<std::string> read_line(Duration timeout);
  linux_os::UnixSocket socket_;
  LineBuffer lines_{16 * 1024 * 1024};
  std::int64_t next_id_ = 1;
  Json last_failure_;
};

}  // namespace gannet::control

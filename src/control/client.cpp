#include "src/control/client.hpp"

#include <array>
#include <utility>

#include "platform/linux/clock.hpp"

namespace gannet::control {

using linux_os::IoStatus;

Result<Client> Client::connect(const std::string& path) {
  auto socket = linux_os::UnixSocket::connect(path, linux_os::SocketKind::kStream);
  if (!socket) return Error{socket.error().text + "; is gannetd running, and may you reach it?"};
  Client client;
  client.socket_ = std::move(*socket);
  return client;
}

Result<Json> Client::call(const std::string& method, const Json& params, Duration timeout) {
  last_failure_ = Json();
  const std::int64_t id = next_id_++;
  const std::string line = request_line({id, method, params});
  if (line.size() > kMaxLine) return Error{method + ": the request is too long"};
  // Far smaller than a socket's buffer, so it goes out at once or not at all.
  const auto sent = socket_.send(std::as_bytes(std::span(line)));
  if (sent.status != IoStatus::kDone || sent.size != line.size()) {
    return Error{method + ": the daemon does not take the request"};
  }
  while (true) {
    auto text = read_line(timeout);
    if (!text) return Error{method + ": " + text.error().text};
    const Json answer = Json::parse(*text, nullptr, false);
    if (!answer.is_object()) return Error{method + ": the answer is not JSON"};
    if (answer.contains("id") && answer["id"].is_number() && answer["id"] != id) continue;
    if (answer.contains("result")) return answer["result"];
    if (!answer.contains("error")) return Error{method + ": the answer has no result"};
    last_failure_ = answer["error"];
    const bool has_text = last_failure_.is_object() && last_failure_.contains("text") &&
                          last_failure_["text"].is_string();
    return Error{method + ": " + (has_text ? last_failure_["text"].get<std::string>() : "refused")};
  }
}

Result<std::string> Client::read_line(Duration timeout) {
  const TimePoint end = linux_os::monotonic_now() + timeout;
  std::array<char, 16 * 1024> buffer;
  std::string line;
  while (lines_.next(line) != LineBuffer::Next::kLine) {
    const Duration left = end - linux_os::monotonic_now();
    if (left.count() <= 0 || !socket_.wait_readable(left)) {
      return Error{"no answer from the daemon in time"};
    }
    const auto got = socket_.receive(std::as_writable_bytes(std::span(buffer)));
    if (got.status == IoStatus::kWouldBlock) continue;
    if (got.status != IoStatus::kDone) return Error{"the daemon has gone"};
    lines_.append({buffer.data(), got.size});
  }
  return line;
}

}  // namespace gannet::control

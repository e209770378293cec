#include "src/control/server.hpp"

#include <array>
#include <utility>

namespace gannet::control {

using linux_os::IoStatus;

Result<std::unique_ptr<Server>> Server::listen(const std::string& path, const std::string& group) {
  if (path.starts_with('@')) {
    return Error{"control.socket: '" + path + "' must be a path: an abstract name has no owner " +
                 "and no group, anybody could connect"};
  }
  auto listener = linux_os::UnixListener::listen(path, linux_os::SocketKind::kStream,
                                                 group.empty() ? 0600 : 0660, group);
  if (!listener) return Error{"control.socket: " + listener.error().text};
  std::unique_ptr<Server> server(new Server());
  server->listener_ = std::move(*listener);
  return server;
}

void Server::add_poll(std::vector<pollfd>& fds) const {
  fds.push_back({listener_.fd(), POLLIN, 0});
  for (const Client& client : clients_) {
    const auto wanted = static_cast<short>(client.pending.empty() ? POLLIN : POLLIN | POLLOUT);
    fds.push_back({client.socket.fd(), wanted, 0});
  }
}

void Server::serve(const Handler& handler) {
  accept_newcomers();
  for (Client& client : clients_) {
    flush(client);
    receive(client, handler);
  }
  clients_.remove_if([](const Client& client) { return client.gone; });
}

void Server::accept_newcomers() {
  while (auto socket = listener_.accept()) {
    counters_.connections += 1;
    if (clients() < kMaxClients) {
      clients_.push_back({std::move(*socket)});
      continue;
    }
    counters_.dropped += 1;
    const std::string line =
        answer_line(nullptr, Failure{ErrorCode::kBusy, "too many clients are connected"});
    socket->send(std::as_bytes(std::span(line)));
  }
}

// At most one buffer a turn, so that a client who floods us does not keep the others waiting.
void Server::receive(Client& client, const Handler& handler) {
  std::array<char, 16 * 1024> buffer;
  const auto got = client.socket.receive(std::as_writable_bytes(std::span(buffer)));
  if (got.status == IoStatus::kWouldBlock) return;
  if (got.status != IoStatus::kDone) {
    client.gone = true;
    return;
  }
  client.lines.append({buffer.data(), got.size});
  std::string line;
  while (true) {
    const auto next = client.lines.next(line);
    if (next == LineBuffer::Next::kNothing) return;
    if (next == LineBuffer::Next::kLine) {
      answer(client, line, handler);
    } else {
      counters_.junk += 1;
      client.pending += answer_line(
          nullptr, Failure{ErrorCode::kBadJson,
                           "a line may have " + std::to_string(kMaxLine) + " bytes at the most"});
    }
    flush(client);
  }
}

void Server::answer(Client& client, const std::string& line, const Handler& handler) {
  auto parsed = parse_request(line);
  if (const auto* bad = std::get_if<BadRequest>(&parsed)) {
    counters_.junk += 1;
    client.pending += answer_line(bad->id, bad->failure);
    return;
  }
  counters_.requests += 1;
  const Request& request = std::get<Request>(parsed);
  client.pending += answer_line(request.id, handler(request));
}

void Server::flush(Client& client) {
  while (!client.pending.empty()) {
    const auto sent = client.socket.send(std::as_bytes(std::span(client.pending)));
    if (sent.status == IoStatus::kWouldBlock) break;
    if (sent.status != IoStatus::kDone) {
      client.gone = true;
      return;
    }
    client.pending.erase(0, sent.size);
  }
  if (client.pending.size() > kMaxPending) {
    counters_.dropped += 1;
    client.gone = true;
  }
}

}  // namespace gannet::control

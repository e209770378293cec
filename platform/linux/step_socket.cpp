#include "platform/linux/step_socket.hpp"

#include <time.h>

#include <array>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "platform/linux/clock.hpp"

namespace gannet::linux_os {
namespace {

constexpr std::string_view kStep = "step ";
constexpr std::string_view kDone = "done ";
using Line = std::array<char, 40>;

std::span<const std::byte> write_line(Line& line, std::string_view word, TimePoint t) {
  std::memcpy(line.data(), word.data(), word.size());
  char* end = std::to_chars(line.data() + word.size(), line.data() + line.size() - 1, to_ns(t)).ptr;
  *end++ = '\n';
  return std::as_bytes(std::span(line.data(), end));
}

std::optional<TimePoint> read_line(std::string_view line, std::string_view word) {
  if (!line.starts_with(word) || !line.ends_with('\n')) return {};
  line.remove_prefix(word.size());
  line.remove_suffix(1);
  std::int64_t ns = -1;
  const auto [end, problem] = std::from_chars(line.data(), line.data() + line.size(), ns);
  if (problem != std::errc() || end != line.data() + line.size() || ns < 0) return {};
  return time_from_ns(ns);
}

StepClient::Status receive_line(UnixSocket& socket, std::string_view word, TimePoint& t) {
  Line line;
  const IoResult got = socket.receive(std::as_writable_bytes(std::span(line)));
  if (got.status == IoStatus::kWouldBlock) return StepClient::Status::kNothing;
  if (got.status == IoStatus::kTooLong) return StepClient::Status::kMalformed;
  if (got.status != IoStatus::kDone) return StepClient::Status::kGone;
  const auto time = read_line({line.data(), got.size}, word);
  if (!time) return StepClient::Status::kMalformed;
  t = *time;
  return StepClient::Status::kStep;
}

}  // namespace

Result<StepServer> StepServer::listen(const std::string& name) {
  auto listener = UnixListener::listen(name, SocketKind::kSeqPacket);
  if (!listener) return listener.error();
  StepServer server;
  server.listener_ = std::move(*listener);
  return server;
}

Result<void> StepServer::wait_for_daemon(Duration timeout) {
  if (listener_.wait_readable(timeout)) {
    if (auto socket = listener_.accept()) {
      daemon_ = std::move(*socket);
      return {};
    }
  }
  return Error{"no daemon has connected to the step socket: is clock.kind \"stepped\"?"};
}

Result<void> StepServer::step(TimePoint t, Duration timeout) {
  Line line;
  const std::string at = "step " + std::to_string(to_ns(t)) + " ns: ";
  if (daemon_.send(write_line(line, kStep, t)).status != IoStatus::kDone) {
    return Error{at + "the daemon has gone"};
  }
  if (!daemon_.wait_readable(timeout)) return Error{at + "the daemon does not answer"};
  TimePoint answered;
  switch (receive_line(daemon_, kDone, answered)) {
    case StepClient::Status::kStep:
      if (answered == t) return {};
      return Error{at + "the daemon answered for " + std::to_string(to_ns(answered)) + " ns"};
    case StepClient::Status::kGone:
      return Error{at + "the daemon has gone"};
    default:
      return Error{at + "the daemon's answer is not 'done <t_ns>'"};
  }
}

Result<StepClient> StepClient::connect(const std::string& name, Duration timeout) {
  const TimePoint end = monotonic_now() + timeout;
  while (true) {
    auto socket = UnixSocket::connect(name, SocketKind::kSeqPacket);
    if (socket) {
      StepClient client;
      client.world_ = std::move(*socket);
      return client;
    }
    if (monotonic_now() >= end) {
      return Error{"clock.step_socket: " + socket.error().text + "; start gannet-world first"};
    }
    const timespec pause = {0, 20'000'000};
    nanosleep(&pause, nullptr);
  }
}

StepClient::Status StepClient::receive(TimePoint& t, Duration timeout) {
  if (!world_.wait_readable(timeout)) return Status::kNothing;
  return receive_line(world_, kStep, t);
}

bool StepClient::answer_done(TimePoint t) {
  Line line;
  return world_.send(write_line(line, kDone, t)).status == IoStatus::kDone;
}

}  // namespace gannet::linux_os

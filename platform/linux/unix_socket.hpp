// Unix sockets, non-blocking: a listener and connected sockets, of bytes (stream) or of whole
// messages (SOCK_SEQPACKET). A name that begins with '@' is abstract, else a path.
// listen and connect are start-up or control thread; send and receive are RT safe, one thread at a
// time. Owners close by destruction.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "platform/base/result.hpp"
#include "platform/base/time.hpp"
#include "platform/linux/fd.hpp"

namespace gannet::linux_os {

enum class SocketKind { kStream, kSeqPacket };

enum class IoStatus {
  kDone,
  kWouldBlock,  // nothing there, or no room
  kClosed,      // the peer has gone
  kTooLong,     // a message was longer than the buffer: it is lost
  kError,
};

struct IoResult {
  IoStatus status = IoStatus::kError;
  std::size_t size = 0;  // bytes moved
};

struct PeerCredentials {
  pid_t pid = 0;
  uid_t uid = 0;
  gid_t gid = 0;
};

class UnixSocket {
 public:
  // Error: nobody serves the name.
  static Result<UnixSocket> connect(const std::string& name, SocketKind kind);

  UnixSocket() = default;
  explicit UnixSocket(Fd fd) : fd_(std::move(fd)) {}

  bool valid() const { return fd_.valid(); }
  int fd() const { return fd_.get(); }
  void close() { fd_.reset(); }

  // A stream may take a part; a message is taken whole or not at all.
  IoResult send(std::span<const std::byte> bytes);
  IoResult receive(std::span<std::byte> bytes);
  // Waits until there is something to receive (or the peer has gone); false: time-out.
  bool wait_readable(Duration timeout) const;
  std::optional<PeerCredentials> peer() const;

 private:
  Fd fd_;
};

class UnixListener {
 public:
  // A path left behind by one that died is taken over; one that is served is refused. Beside the
  // path lies a "<path>.lock" that is locked while we serve, so that two that start at once
  // cannot both win. mode: permission bits of the path; group: its group's name, empty: ours.
  static Result<UnixListener> listen(const std::string& name, SocketKind kind, unsigned mode = 0600,
                                     const std::string& group = "");

  UnixListener() = default;
  UnixListener(UnixListener&&) noexcept = default;
  UnixListener& operator=(UnixListener&& other) noexcept;
  ~UnixListener();

  bool valid() const { return fd_.valid(); }
  int fd() const { return fd_.get(); }
  // Empty: nobody waits.
  std::optional<UnixSocket> accept();
  bool wait_readable(Duration timeout) const;

 private:
  void close();
  Fd lock_;
  Fd fd_;
  std::string path_;  // empty for an abstract name
};

}  // namespace gannet::linux_os

#include "platform/linux/unix_socket.hpp"

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace gannet::linux_os {
namespace {

struct Address {
  sockaddr_un un = {};
  socklen_t length = 0;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&un); }
};

Result<Address> make_address(const std::string& name) {
  Address address;
  address.un.sun_family = AF_UNIX;
  if (name.empty() || name.size() >= sizeof address.un.sun_path) {
    return Error{"socket name '" + name + "' must have 1 to " +
                 std::to_string(sizeof address.un.sun_path - 1) + " bytes"};
  }
  std::memcpy(address.un.sun_path, name.data(), name.size());
  const bool abstract = name[0] == '@';
  if (abstract) address.un.sun_path[0] = '\0';
  // An abstract name ends by its length, a path by its zero.
  address.length =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size() + (abstract ? 0 : 1));
  return address;
}

Fd make_socket(SocketKind kind) {
  const int type = kind == SocketKind::kStream ? SOCK_STREAM : SOCK_SEQPACKET;
  return Fd(socket(AF_UNIX, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

bool poll_readable(int fd, Duration timeout) {
  pollfd p = {fd, POLLIN, 0};
  const timespec t = {static_cast<time_t>(timeout.count() / 1'000'000'000),
                      static_cast<long>(timeout.count() % 1'000'000'000)};
  return ppoll(&p, 1, &t, nullptr) > 0;
}

IoStatus status_of(int error_number) {
  switch (error_number) {
    case EAGAIN:
    case ENOBUFS:
    case EINTR:
      return IoStatus::kWouldBlock;
    case EPIPE:
    case ECONNRESET:
    case ENOTCONN:
      return IoStatus::kClosed;
    case EMSGSIZE:
      return IoStatus::kTooLong;
    default:
      return IoStatus::kError;
  }
}

Error in_use(const std::string& name) {
  return Error{"socket '" + name + "' is already served by another process: stop that one first, " +
               "or choose another name"};
}

bool is_served(const Address& address, SocketKind kind) {
  const Fd probe = make_socket(kind);
  if (!probe.valid()) return false;
  if (connect(probe.get(), address.get(), address.length) == 0) return true;
  // EAGAIN: alive with a full backlog; EPROTOTYPE: alive, of another kind.
  return errno == EAGAIN || errno == EPROTOTYPE;
}

Result<Fd> lock_path(const std::string& path) {
  const std::string lock_path = path + ".lock";
  Fd lock(open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!lock.valid()) return system_error("lock file '" + lock_path + "'", errno);
  if (flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return in_use(path);
    return system_error("lock file '" + lock_path + "'", errno);
  }
  return lock;
}

Result<void> set_access(const std::string& path, unsigned mode, const std::string& group) {
  if (!group.empty()) {
    const struct group* entry = getgrnam(group.c_str());
    if (entry == nullptr) return Error{"group '" + group + "' of socket '" + path + "' is unknown"};
    struct stat status = {};
    // Left out where it is so already: a sandboxed service has no right to the call at all.
    const bool is_theirs = lstat(path.c_str(), &status) == 0 && status.st_gid == entry->gr_gid;
    if (!is_theirs && chown(path.c_str(), static_cast<uid_t>(-1), entry->gr_gid) != 0) {
      return system_error("socket '" + path + "' cannot be given to group '" + group + "'", errno);
    }
  }
  if (chmod(path.c_str(), mode) != 0) {
    return system_error("socket '" + path + "': permission bits", errno);
  }
  return {};
}

}  // namespace

Result<UnixSocket> UnixSocket::connect(const std::string& name, SocketKind kind) {
  const auto address = make_address(name);
  if (!address) return address.error();
  Fd fd = make_socket(kind);
  if (!fd.valid()) return system_error("socket", errno);
  // EAGAIN: somebody serves, but newcomers wait already; a tenth of a second is worth the wait.
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (::connect(fd.get(), address->get(), address->length) == 0) return UnixSocket(std::move(fd));
    if (errno != EAGAIN) return system_error("nobody serves the socket '" + name + "'", errno);
    usleep(5000);
  }
  return Error{"the server of the socket '" + name + "' does not take newcomers"};
}

IoResult UnixSocket::send(std::span<const std::byte> bytes) {
  const ssize_t n = ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (n < 0) return {status_of(errno), 0};
  return {IoStatus::kDone, static_cast<std::size_t>(n)};
}

IoResult UnixSocket::receive(std::span<std::byte> bytes) {
  // MSG_TRUNC: a message's true length; for a stream it would discard bytes, hence recvmsg's flag.
  iovec part = {bytes.data(), bytes.size()};
  msghdr message = {};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  const ssize_t n = recvmsg(fd_.get(), &message, MSG_DONTWAIT);
  if (n < 0) return {status_of(errno), 0};
  if ((message.msg_flags & MSG_TRUNC) != 0) return {IoStatus::kTooLong, 0};
  if (n == 0 && !bytes.empty()) return {IoStatus::kClosed, 0};
  return {IoStatus::kDone, static_cast<std::size_t>(n)};
}

bool UnixSocket::wait_readable(Duration timeout) const { return poll_readable(fd_.get(), timeout); }

std::optional<PeerCredentials> UnixSocket::peer() const {
  ucred credentials = {};
  socklen_t length = sizeof credentials;
  if (getsockopt(fd_.get(), SOL_SOCKET, SO_PEERCRED, &credentials, &length) != 0) return {};
  return PeerCredentials{credentials.pid, credentials.uid, credentials.gid};
}

Result<UnixListener> UnixListener::listen(const std::string& name, SocketKind kind, unsigned mode,
                                          const std::string& group) {
  const auto address = make_address(name);
  if (!address) return address.error();
  UnixListener listener;
  const bool is_path = name[0] != '@';
  if (is_path) {
    auto lock = lock_path(name);
    if (!lock) return lock.error();
    listener.lock_ = std::move(*lock);
    // Also a server that knows nothing of our lock file is not to be pushed aside.
    if (is_served(*address, kind)) return in_use(name);
    struct stat status = {};
    if (lstat(name.c_str(), &status) == 0) {
      if (!S_ISSOCK(status.st_mode)) return Error{"'" + name + "' exists and is not a socket"};
      unlink(name.c_str());
    }
  }
  listener.fd_ = make_socket(kind);
  if (!listener.fd_.valid()) return system_error("socket", errno);
  // Closed to all until the mode is set.
  const mode_t old_mask = umask(0777);
  const int bound = bind(listener.fd_.get(), address->get(), address->length);
  const int problem = errno;
  umask(old_mask);
  if (bound != 0) {
    if (problem == EADDRINUSE) return in_use(name);
    return system_error("socket '" + name + "'", problem);
  }
  if (is_path) {
    listener.path_ = name;
    if (auto done = set_access(name, mode, group); !done) return done.error();
  }
  if (::listen(listener.fd_.get(), 16) != 0) return system_error("socket '" + name + "'", errno);
  return listener;
}

UnixListener& UnixListener::operator=(UnixListener&& other) noexcept {
  if (this != &other) {
    close();
    lock_ = std::move(other.lock_);
    fd_ = std::move(other.fd_);
    path_ = std::exchange(other.path_, {});
  }
  return *this;
}

UnixListener::~UnixListener() { close(); }

void UnixListener::close() {
  if (!fd_.valid()) return;
  if (!path_.empty()) unlink(path_.c_str());
  fd_.reset();
  lock_.reset();
}

std::optional<UnixSocket> UnixListener::accept() {
  Fd fd(accept4(fd_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!fd.valid()) return {};
  return UnixSocket(std::move(fd));
}

bool UnixListener::wait_readable(Duration timeout) const {
  return poll_readable(fd_.get(), timeout);
}

}  // namespace gannet::linux_os

#include "platform/linux/whole_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace gannet::linux_os {
namespace {

Error failure(const std::string& path, const char* what) {
  return Error{path + ": " + what + ": " + std::strerror(errno)};
}

// Closes at the scope's end.
struct Descriptor {
  int fd;
  explicit Descriptor(int descriptor) : fd(descriptor) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

// mkstemp makes 0600; a file that people share gets what open() would have given it.
mode_t usual_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::size_t max_bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.fd < 0) return failure(path, "cannot open");
  struct stat about = {};
  if (::fstat(file.fd, &about) != 0) return failure(path, "cannot stat");
  if (!S_ISREG(about.st_mode)) return Error{path + ": not a regular file"};
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size > max_bytes)
    return Error{path + ": " + std::to_string(size) + " bytes, more than the " +
                 std::to_string(max_bytes) + " that are accepted"};
  std::vector<std::uint8_t> bytes(size);
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(file.fd, bytes.data() + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return failure(path, "cannot read");
    if (n == 0) break;  // it shrank meanwhile: what is there is what counts
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(got);
  return bytes;
}

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  std::string temporary = path + ".XXXXXX";
  const Descriptor file(::mkostemp(temporary.data(), O_CLOEXEC));
  if (file.fd < 0) return failure(path, "cannot create a file beside it");
  const bool done = write_all(file.fd, bytes) && ::fchmod(file.fd, usual_mode()) == 0 &&
                    ::fsync(file.fd) == 0 && std::rename(temporary.c_str(), path.c_str()) == 0;
  if (done) return {};
  const Error error = failure(path, "cannot write");
  ::unlink(temporary.c_str());
  return error;
}

Result<void> write_file(const std::string& path, const std::string& text) {
  return write_file(
      path, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace gannet::linux_os

#include "platform/linux/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "platform/linux/fd.hpp"

namespace gannet::linux_os {
namespace {

bool write_all(int fd, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

// Of this process and call alone; made with open(), so that the umask gives it its mode.
std::string temporary_beside(const std::string& path) {
  static std::atomic<unsigned> calls{0};
  return path + "." + std::to_string(::getpid()) + "." + std::to_string(calls++) + ".new";
}

// Devices, pipes and terminals keep their name and take what is written; nothing of theirs is lost
// when it ends halfway.
Result<void> write_into(const std::string& path, std::span<const std::uint8_t> bytes) {
  const Fd file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.valid() && write_all(file.get(), bytes)) return {};
  return system_error(path + ": cannot write", errno);
}

// Where the bytes belong: a symbolic link stays, the file behind it is replaced.
std::string behind_links(const std::string& path) {
  const std::unique_ptr<char, void (*)(void*)> real(::realpath(path.c_str(), nullptr), &std::free);
  return real ? std::string(real.get()) : path;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::size_t max_bytes) {
  const Fd file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.valid()) return system_error(path + ": cannot open", errno);
  struct stat about = {};
  if (::fstat(file.get(), &about) != 0) return system_error(path + ": cannot stat", errno);
  if (!S_ISREG(about.st_mode)) return Error{path + ": not a regular file"};
  const auto size = static_cast<std::size_t>(about.st_size);
  if (size > max_bytes)
    return Error{path + ": " + std::to_string(size) + " bytes, more than the " +
                 std::to_string(max_bytes) + " that are accepted"};
  std::vector<std::uint8_t> bytes(size);
  std::size_t got = 0;
  while (got < size) {
    const ssize_t n = ::read(file.get(), bytes.data() + got, size - got);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return system_error(path + ": cannot read", errno);
    if (n == 0) break;  // it shrank meanwhile: what is there is what counts
    got += static_cast<std::size_t>(n);
  }
  bytes.resize(got);
  return bytes;
}

Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes) {
  struct stat about = {};
  const bool exists = ::stat(path.c_str(), &about) == 0;
  if (exists && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode)) return write_into(path, bytes);
  const std::string final_path = exists ? behind_links(path) : path;
  const std::string temporary = temporary_beside(final_path);
  const Fd file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.valid()) return system_error(path + ": cannot create a file beside it", errno);
  const bool done = write_all(file.get(), bytes) && ::fsync(file.get()) == 0 &&
                    std::rename(temporary.c_str(), final_path.c_str()) == 0;
  if (done) return {};
  const Error error = system_error(path + ": cannot write", errno);
  ::unlink(temporary.c_str());
  return error;
}

Result<void> write_file(const std::string& path, const std::string& text) {
  return write_file(path,
                    std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace gannet::linux_os

#include "platform/linux/mapped_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "platform/linux/fd.hpp"

namespace gannet::linux_os {
namespace {

std::string full_path(const std::string& name) {
  return name.find('/') == std::string::npos ? "/dev/shm/" + name : name;
}

// MAP_POPULATE: the pages are there before a real-time thread touches them.
void* map(int fd, std::size_t size, bool writable) {
  return mmap(nullptr, size, writable ? PROT_READ | PROT_WRITE : PROT_READ,
              MAP_SHARED | MAP_POPULATE, fd, 0);
}

}  // namespace

Result<MappedMemory> MappedMemory::create(const std::string& name, std::size_t size,
                                          unsigned mode) {
  MappedMemory memory;
  memory.path_ = full_path(name);
  const std::string growing = memory.path_ + ".new";
  const std::string what = "shared memory '" + memory.path_ + "' cannot be created";
  ::unlink(growing.c_str());
  const Fd fd(::open(growing.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode));
  if (!fd.valid()) return system_error(what, errno);
  // posix_fallocate takes the room now: a full /dev/shm must not be a SIGBUS later.
  const int no_room = size == 0 ? EINVAL : posix_fallocate(fd.get(), 0, static_cast<off_t>(size));
  void* data = no_room != 0 ? MAP_FAILED : map(fd.get(), size, true);
  const int problem = no_room != 0 ? no_room : errno;
  if (data == MAP_FAILED || std::rename(growing.c_str(), memory.path_.c_str()) != 0) {
    const Error error = system_error(what, data == MAP_FAILED ? problem : errno);
    if (data != MAP_FAILED) munmap(data, size);
    ::unlink(growing.c_str());
    return error;
  }
  memory.data_ = static_cast<std::byte*>(data);
  memory.size_ = size;
  memory.owner_ = true;
  return memory;
}

Result<MappedMemory> MappedMemory::open(const std::string& name, bool writable) {
  MappedMemory memory;
  memory.path_ = full_path(name);
  const std::string what = "shared memory '" + memory.path_ + "' cannot be opened";
  const Fd fd(::open(memory.path_.c_str(), (writable ? O_RDWR : O_RDONLY) | O_CLOEXEC));
  struct stat status = {};
  if (!fd.valid() || fstat(fd.get(), &status) != 0) return system_error(what, errno);
  if (!S_ISREG(status.st_mode) || status.st_size == 0) {
    return Error{what + ": it is empty or not a file"};
  }
  memory.size_ = static_cast<std::size_t>(status.st_size);
  void* data = map(fd.get(), memory.size_, writable);
  if (data == MAP_FAILED) return system_error(what, errno);
  memory.data_ = static_cast<std::byte*>(data);
  return memory;
}

MappedMemory::MappedMemory(MappedMemory&& other) noexcept { *this = std::move(other); }

MappedMemory& MappedMemory::operator=(MappedMemory&& other) noexcept {
  if (this != &other) {
    unmap();
    data_ = std::exchange(other.data_, nullptr);
    size_ = std::exchange(other.size_, 0);
    path_ = std::move(other.path_);
    owner_ = std::exchange(other.owner_, false);
  }
  return *this;
}

MappedMemory::~MappedMemory() { unmap(); }

void MappedMemory::unmap() {
  if (data_ == nullptr) return;
  munmap(data_, size_);
  if (owner_) ::unlink(path_.c_str());
  data_ = nullptr;
}

}  // namespace gannet::linux_os

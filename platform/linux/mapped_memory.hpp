// MappedMemory: a file mapped as memory that processes share. Who creates it owns the file and
// removes it at the end; who opens it keeps a good mapping also when the owner has gone.
// A name without a slash lies in /dev/shm. create and open are start-up only; the bytes belong to
// whoever the users agree on.
#pragma once

#include <cstddef>
#include <string>

#include "platform/base/result.hpp"

namespace gannet::linux_os {

class MappedMemory {
 public:
  // A new zeroed file of this size, in place of one of that name. It appears under its name only
  // when it has its full size. mode: permission bits.
  static Result<MappedMemory> create(const std::string& name, std::size_t size,
                                     unsigned mode = 0600);
  // An existing one, whole. writable = false maps it for reading alone.
  static Result<MappedMemory> open(const std::string& name, bool writable);

  MappedMemory() = default;
  MappedMemory(MappedMemory&& other) noexcept;
  MappedMemory& operator=(MappedMemory&& other) noexcept;
  ~MappedMemory();

  std::byte* data() { return data_; }  // not to be written if mapped for reading
  const std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  void unmap();
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  std::string path_;
  bool owner_ = false;
};

}  // namespace gannet::linux_os

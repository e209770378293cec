// Whole files in one call: read into memory, or written so that nobody ever sees half of one.
// Normal threads only (heap, blocking I/O). Error: the path, the system's reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::linux_os {

// Refuses what is not a regular file, and files above max_bytes.
Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::size_t max_bytes);

// Writes a temporary file beside path, flushes it and renames it over path: on failure the old
// file stays as it was. What is no regular file (a device, a pipe) is written into, not replaced; a
// symbolic link stays.
Result<void> write_file(const std::string& path, std::span<const std::uint8_t> bytes);
Result<void> write_file(const std::string& path, const std::string& text);

}  // namespace gannet::linux_os

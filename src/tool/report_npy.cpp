#include "src/tool/report_npy.hpp"

#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "hal/camera/image.hpp"
#include "platform/linux/whole_file.hpp"

namespace gannet::tool {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr char kMagic[] = "\x93NUMPY";
constexpr std::size_t kMagicBytes = 6;

// The header's text, and where the data begin.
struct Header {
  std::string_view text;
  std::size_t end = 0;
};

std::optional<Header> header_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 12 || std::memcmp(bytes.data(), kMagic, kMagicBytes) != 0) return {};
  const std::size_t length_bytes = bytes[kMagicBytes] == 1 ? 2 : 4;
  std::size_t length = 0;
  for (std::size_t i = 0; i < length_bytes; ++i)
    length |= std::size_t{bytes[kMagicBytes + 2 + i]} << (8 * i);
  const std::size_t begin = kMagicBytes + 2 + length_bytes;
  if (length > bytes.size() - begin) return {};
  return Header{{reinterpret_cast<const char*>(bytes.data()) + begin, length}, begin + length};
}

bool says(std::string_view text, std::string_view words) {
  return text.find(words) != std::string_view::npos;
}

// "'shape': (500, 741)" → height, width; zero if it is otherwise.
void read_shape(std::string_view text, FloatMap& map) {
  const std::string_view key = "'shape': (";
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return;
  const char* const end = text.data() + text.size();
  const auto height = std::from_chars(text.data() + at + key.size(), end, map.height);
  if (height.ec != std::errc() || end - height.ptr < 2 || std::memcmp(height.ptr, ", ", 2) != 0)
    return;
  const auto width = std::from_chars(height.ptr + 2, end, map.width);
  if (width.ec != std::errc() || width.ptr == end || *width.ptr != ')') map.width = 0;
}

}  // namespace

Result<FloatMap> decode_npy(std::span<const std::uint8_t> bytes, const std::string& path) {
  const auto header = header_of(bytes);
  if (!header) return Error{path + ": is no .npy file, or its header is cut off"};
  if (!says(header->text, "'descr': '<f4'") || !says(header->text, "'fortran_order': False"))
    return Error{path + ": must hold little-endian 32-bit floats, row by row"};
  FloatMap map;
  read_shape(header->text, map);
  if (map.width <= 0 || map.height <= 0 || map.width > hal::kMaxImageSide ||
      map.height > hal::kMaxImageSide)
    return Error{path + ": must have two dimensions, the sides of an image"};
  map.values.resize(static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
  const std::size_t wanted = map.values.size() * sizeof(float);
  if (bytes.size() - header->end != wanted)
    return Error{path + ": has " + std::to_string(bytes.size() - header->end) +
                 " bytes of data, but its shape needs " + std::to_string(wanted)};
  std::memcpy(map.values.data(), bytes.data() + header->end, wanted);
  return map;
}

Result<FloatMap> read_npy(const std::string& path) {
  const auto bytes = linux_os::read_file(path, kMostBytes);
  if (!bytes) return bytes.error();
  return decode_npy(*bytes, path);
}

}  // namespace gannet::tool

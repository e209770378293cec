#include "src/image_file/image_file.hpp"

#include <algorithm>

#include "hal/camera/pixel_access.hpp"
#include "platform/linux/whole_file.hpp"
#include "src/image_file/jpeg.hpp"
#include "src/image_file/png.hpp"

namespace gannet::image_file {
namespace {

// Reads the file and decodes it; errors get the path.
template <class Decode>
auto read(const std::string& path, Decode decode) -> decltype(decode({})) {
  const auto bytes = linux_os::read_file(path, kMaxFileBytes);
  if (!bytes) return bytes.error();
  auto result = decode(std::span<const std::uint8_t>(*bytes));
  if (!result) return Error{path + ": " + result.error().text};
  return result;
}

Result<void> write(const std::string& path, const Result<std::vector<std::uint8_t>>& bytes) {
  if (!bytes) return Error{path + ": " + bytes.error().text};
  return linux_os::write_file(path, std::span<const std::uint8_t>(*bytes));
}

// From all 16 bits: what is not zero stays so, however dark.
Raster8 mask_of(const Raster16& rgba) {
  Raster8 mask(rgba.width, rgba.height, 1);
  bool transparent = false;
  for (std::size_t i = 0; i < mask.samples.size(); ++i)
    transparent = transparent || rgba.samples[4 * i + 3] != 0xffff;
  for (std::size_t i = 0; i < mask.samples.size(); ++i) {
    const std::uint16_t* pixel = &rgba.samples[4 * i];
    const int value = transparent ? pixel[3] : std::max({pixel[0], pixel[1], pixel[2]});
    mask.samples[i] = static_cast<std::uint8_t>(value == 0 ? 0 : std::max(1, value >> 8));
  }
  return mask;
}

Raster8 mask_of(const hal::ImageView& view) {
  Raster8 mask(view.width, view.height, 1);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) *mask.at(x, y) = hal::yuv_at(view, x, y).y > 127 ? 255 : 0;
  return mask;
}

}  // namespace

Result<hal::Image> decode_image(std::span<const std::uint8_t> bytes) {
  if (is_png(bytes)) return decode_png(bytes);
  if (is_jpeg(bytes)) return decode_jpeg(bytes);
  if (bytes.empty()) return Error{"the file is empty"};
  return Error{"neither a PNG nor a JPEG"};
}

Result<hal::Image> read_image(const std::string& path) { return read(path, decode_image); }

Result<Raster8> read_png_rgba(const std::string& path) {
  return read(path, [](std::span<const std::uint8_t> bytes) { return decode_png8(bytes, 4); });
}

Result<Raster8> read_mask(const std::string& path) {
  return read(path, [](std::span<const std::uint8_t> bytes) -> Result<Raster8> {
    if (is_png(bytes)) {
      const Result<Raster16> rgba = decode_png16(bytes, 4);
      if (!rgba) return rgba.error();
      return mask_of(*rgba);
    }
    const Result<hal::Image> image = decode_image(bytes);
    if (!image) return image.error();
    return mask_of(image->view());
  });
}

Result<void> write_png(const std::string& path, const hal::ImageView& view) {
  return write(path, encode_png(view));
}

Result<void> write_png(const std::string& path, const Raster8& raster) {
  return write(path, encode_png(raster));
}

Result<void> write_png(const std::string& path, const Raster16& raster) {
  return write(path, encode_png(raster));
}

Result<void> write_jpeg(const std::string& path, const hal::ImageView& view, int quality) {
  return write(path, encode_jpeg(view, quality));
}

}  // namespace gannet::image_file

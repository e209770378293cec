#include "src/image_file/jpeg.hpp"

#include <turbojpeg.h>

#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "src/image_file/png.hpp"

namespace gannet::image_file {
namespace {

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, CloseHandle>;

struct Header {
  int width = 0, height = 0, subsampling = 0, colour_space = 0;
};

// Planes as the library writes them: padded to whole chroma cells.
struct Planes {
  int count = 3;
  std::array<int, 3> width = {}, height = {};
  std::array<std::vector<std::uint8_t>, 3> bytes;
};

// True if what the library complains of leaves the image whole. Cameras pad their frames: that is
// worth a warning to the library and nothing to us.
bool is_harmless(tjhandle handle) {
  return tjGetErrorCode(handle) == TJERR_WARNING &&
         std::strstr(tjGetErrorStr2(handle), "extraneous bytes before marker") != nullptr;
}

Error broken(tjhandle handle, std::size_t size) {
  return Error{"broken JPEG (" + std::to_string(size) + " bytes): " + tjGetErrorStr2(handle)};
}

Result<Header> read_header(tjhandle handle, std::span<const std::uint8_t> bytes) {
  Header header;
  if (!is_jpeg(bytes)) return Error{"not a JPEG"};
  if (tjDecompressHeader3(handle, bytes.data(), bytes.size(), &header.width, &header.height,
                          &header.subsampling, &header.colour_space) != 0)
    return broken(handle, bytes.size());
  if (header.width < 1 || header.height < 1 || header.width > hal::kMaxImageSide ||
      header.height > hal::kMaxImageSide || std::int64_t{header.width} * header.height > kMaxPixels)
    return Error{"JPEG of " + std::to_string(header.width) + " × " + std::to_string(header.height) +
                 " pixels, more than are accepted"};
  if (header.colour_space == TJCS_CMYK || header.colour_space == TJCS_YCCK)
    return Error{"JPEG with four colours (CMYK), which no camera makes: convert it to RGB"};
  return header;
}

std::optional<hal::PixelFormat> format_of(int subsampling) {
  switch (subsampling) {
    case TJSAMP_420:
      return hal::PixelFormat::kYuv420;
    case TJSAMP_422:
      return hal::PixelFormat::kYuv422;
    case TJSAMP_444:
      return hal::PixelFormat::kYuv444;
    default:
      return std::nullopt;
  }
}

bool decode_planes(tjhandle handle, std::span<const std::uint8_t> bytes, const Header& header,
                   std::uint8_t* planes[3], int strides[3]) {
  return tjDecompressToYUVPlanes(handle, bytes.data(), bytes.size(), planes, header.width, strides,
                                 header.height, TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) == 0 ||
         is_harmless(handle);
}

Result<hal::Image> decode_directly(tjhandle handle, std::span<const std::uint8_t> bytes,
                                   const Header& header, hal::PixelFormat format) {
  hal::Image image(header.width, header.height, format);
  std::uint8_t* planes[3] = {image.plane(0), image.plane(1), image.plane(2)};
  int strides[3] = {image.stride(0), image.stride(1), image.stride(2)};
  if (!decode_planes(handle, bytes, header, planes, strides)) return broken(handle, bytes.size());
  return image;
}

// Chroma is stored at 1/across, 1/down of the size.
struct Cell {
  int across, down;
};
Cell cell_of(int subsampling) {
  return {subsampling == TJSAMP_GRAY ? 1 : tjMCUWidth[subsampling] / 8,
          subsampling == TJSAMP_GRAY ? 1 : tjMCUHeight[subsampling] / 8};
}

Result<hal::Image> decode_by_repetition(tjhandle handle, std::span<const std::uint8_t> bytes,
                                        const Header& header) {
  Planes stored;
  stored.count = header.subsampling == TJSAMP_GRAY ? 1 : 3;
  std::uint8_t* planes[3] = {};
  int strides[3] = {};
  for (int i = 0; i < stored.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    strides[i] = tjPlaneWidth(i, header.width, header.subsampling);
    stored.bytes[at].resize(tjPlaneSizeYUV(i, header.width, 0, header.height, header.subsampling));
    planes[i] = stored.bytes[at].data();
  }
  if (!decode_planes(handle, bytes, header, planes, strides)) return broken(handle, bytes.size());
  hal::Image image(header.width, header.height, hal::PixelFormat::kYuv444);
  const Cell cell = cell_of(header.subsampling);
  for (int i = 0; i < 3; ++i)
    for (int y = 0; y < header.height; ++y)
      for (int x = 0; x < header.width; ++x) {
        const int row = i == 0 ? y : y / cell.down, column = i == 0 ? x : x / cell.across;
        image.row(i, y)[x] =
            planes[i] == nullptr ? 128 : planes[i][std::ptrdiff_t{row} * strides[i] + column];
      }
  return image;
}

Result<hal::Image> decode_rgb(tjhandle handle, std::span<const std::uint8_t> bytes,
                              const Header& header) {
  hal::Image image(header.width, header.height, hal::PixelFormat::kRgb24);
  if (tjDecompress2(handle, bytes.data(), bytes.size(), image.plane(0), header.width,
                    image.stride(0), header.height, TJPF_RGB,
                    TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS) != 0 &&
      !is_harmless(handle))
    return broken(handle, bytes.size());
  return image;
}

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

Result<hal::Image> decode_jpeg(std::span<const std::uint8_t> bytes) {
  const Handle handle(tjInitDecompress());
  if (!handle) return Error{"no memory for reading a JPEG"};
  const Result<Header> header = read_header(handle.get(), bytes);
  if (!header) return header.error();
  if (header->colour_space == TJCS_RGB) return decode_rgb(handle.get(), bytes, *header);
  const auto format = format_of(header->subsampling);
  if (format && hal::layout_of(*format, header->width, header->height).bytes > 0)
    return decode_directly(handle.get(), bytes, *header, *format);
  return decode_by_repetition(handle.get(), bytes, *header);
}

Result<std::vector<std::uint8_t>> encode_jpeg(const hal::ImageView& view, int quality) {
  if (!hal::is_complete(view)) return Error{"cannot write a JPEG: the image has no pixels"};
  const bool as_stored =
      view.matrix == hal::ColourMatrix::kBt601 && view.range == hal::ColourRange::kFull &&
      (view.format == hal::PixelFormat::kYuv420 || view.format == hal::PixelFormat::kYuv422 ||
       view.format == hal::PixelFormat::kYuv444);
  if (!as_stored) return encode_jpeg(hal::to_yuv444(view).view(), quality);
  const int subsampling = view.format == hal::PixelFormat::kYuv420   ? TJSAMP_420
                          : view.format == hal::PixelFormat::kYuv422 ? TJSAMP_422
                                                                     : TJSAMP_444;
  const Handle handle(tjInitCompress());
  if (!handle) return Error{"no memory for writing a JPEG"};
  const std::uint8_t* planes[3] = {view.plane[0], view.plane[1], view.plane[2]};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const int status =
      tjCompressFromYUVPlanes(handle.get(), planes, view.width, view.stride.data(), view.height,
                              subsampling, &bytes, &size, quality, TJFLAG_ACCURATEDCT);
  std::vector<std::uint8_t> out;
  if (status == 0) out.assign(bytes, bytes + size);
  tjFree(bytes);
  if (status != 0)
    return Error{std::string("cannot write a JPEG: ") + tjGetErrorStr2(handle.get())};
  return out;
}

}  // namespace gannet::image_file

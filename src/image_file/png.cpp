#include "src/image_file/png.hpp"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <string>

namespace gannet::image_file {
namespace {

// libpng reports errors by a call that must not return: we jump back to run(). Everything with a
// destructor lives in this object, outside of the function that is jumped into.
struct Session {
  std::span<const std::uint8_t> in;
  std::size_t position = 0;
  std::vector<std::uint8_t> out;
  std::string error;
  std::jmp_buf escape;

  png_structp png = nullptr;
  png_infop info = nullptr;
  std::uint8_t* samples = nullptr;  // the caller's, by rows
  std::vector<png_bytep> rows;

  [[noreturn]] void fail(const char* reason) {
    error = reason;
    std::longjmp(escape, 1);
  }
};

[[noreturn]] void on_error(png_structp png, png_const_charp reason) {
  static_cast<Session*>(png_get_error_ptr(png))->fail(reason);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, std::size_t bytes) {
  auto& session = *static_cast<Session*>(png_get_io_ptr(png));
  if (bytes > session.in.size() - session.position) session.fail("the file ends too early");
  std::memcpy(to, session.in.data() + session.position, bytes);
  session.position += bytes;
}

void on_write(png_structp png, png_bytep from, std::size_t bytes) {
  auto& out = static_cast<Session*>(png_get_io_ptr(png))->out;
  out.insert(out.end(), from, from + bytes);
}

void on_flush(png_structp) {}

// Runs one step of libpng; false: error is set.
bool run(Session& session, void (*step)(Session&)) {
  if (setjmp(session.escape) != 0) return false;
  step(session);
  return true;
}

struct Header {
  int width, height, colour_type;
  bool has_colour() const { return (colour_type & PNG_COLOR_MASK_COLOR) != 0; }
};

// Reading, in two steps with the caller's memory taken in between.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) {
    session_.in = bytes;
    session_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &session_, on_error, on_warning);
    if (session_.png != nullptr) session_.info = png_create_info_struct(session_.png);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&session_.png, &session_.info, nullptr); }

  Result<Header> read_header() {
    if (!is_png(session_.in)) return Error{"not a PNG"};
    if (session_.info == nullptr) return Error{"no memory for reading a PNG"};
    const bool done = run(session_, [](Session& s) {
      png_set_read_fn(s.png, &s, on_read);
      png_set_user_limits(s.png, hal::kMaxImageSide, hal::kMaxImageSide);
      png_read_info(s.png, s.info);
    });
    if (!done) return failure();
    const Header header{static_cast<int>(png_get_image_width(session_.png, session_.info)),
                        static_cast<int>(png_get_image_height(session_.png, session_.info)),
                        png_get_color_type(session_.png, session_.info)};
    if (std::int64_t{header.width} * header.height > kMaxPixels)
      return Error{"PNG of " + std::to_string(header.width) + " × " +
                   std::to_string(header.height) + " pixels, more than are accepted"};
    return header;
  }

  // Decodes to the channels and bits (8, 16) wanted, into tight rows at samples.
  Result<void> read_pixels(const Header& header, int channels, int bits, std::uint8_t* samples) {
    session_.samples = samples;
    session_.rows.resize(static_cast<std::size_t>(header.height));
    const std::size_t row =
        static_cast<std::size_t>(header.width) * static_cast<std::size_t>(channels * bits / 8);
    for (std::size_t y = 0; y < session_.rows.size(); ++y) session_.rows[y] = samples + y * row;
    bool done = run(session_, [](Session& s) { png_set_expand(s.png); });
    if (done && bits == 8) done = run(session_, [](Session& s) { png_set_scale_16(s.png); });
    if (done && bits == 16)
      done = run(session_, [](Session& s) {
        png_set_expand_16(s.png);
        if (std::endian::native == std::endian::little) png_set_swap(s.png);
      });
    if (done && !header.has_colour() && channels > 1)
      done = run(session_, [](Session& s) { png_set_gray_to_rgb(s.png); });
    if (done && channels == 4)
      done = run(session_, [](Session& s) { png_set_add_alpha(s.png, 0xffff, PNG_FILLER_AFTER); });
    if (done && channels != 4) done = run(session_, [](Session& s) { png_set_strip_alpha(s.png); });
    if (done)
      done = run(session_, [](Session& s) {
        png_set_interlace_handling(s.png);
        png_read_update_info(s.png, s.info);
      });
    if (!done) return failure();
    if (png_get_rowbytes(session_.png, session_.info) != row)
      return Error{"PNG with an unexpected layout of its rows"};
    done = run(session_, [](Session& s) {
      png_read_image(s.png, s.rows.data());
      png_read_end(s.png, nullptr);
    });
    if (!done) return failure();
    return {};
  }

 private:
  Error failure() const {
    return Error{"broken PNG at byte " + std::to_string(session_.position) + " of " +
                 std::to_string(session_.in.size()) + ": " + session_.error};
  }
  Session session_;
};

// By our own weights: libpng's grey depends on the gamma that a file claims.
template <class Sample>
Raster<Sample> luma_of(const Raster<Sample>& rgb) {
  Raster<Sample> grey(rgb.width, rgb.height, 1);
  for (std::size_t i = 0; i < grey.samples.size(); ++i) {
    const Sample* pixel = &rgb.samples[3 * i];
    grey.samples[i] =
        static_cast<Sample>((299u * pixel[0] + 587u * pixel[1] + 114u * pixel[2] + 500u) / 1000u);
  }
  return grey;
}

template <class Sample>
Result<Raster<Sample>> decode(std::span<const std::uint8_t> bytes, int channels) {
  Reader reader(bytes);
  const Result<Header> header = reader.read_header();
  if (!header) return header.error();
  const bool to_grey = channels == 1 && header->has_colour();
  Raster<Sample> raster(header->width, header->height, to_grey ? 3 : channels);
  const Result<void> done =
      reader.read_pixels(*header, raster.channels, 8 * static_cast<int>(sizeof(Sample)),
                         reinterpret_cast<std::uint8_t*>(raster.samples.data()));
  if (!done) return done.error();
  if (to_grey) return luma_of(raster);
  return raster;
}

struct Writer : Session {
  int width = 0, height = 0, bits = 8, colour_type = PNG_COLOR_TYPE_RGB;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

void write_all(Session& session) {
  auto& w = static_cast<Writer&>(session);
  png_set_write_fn(w.png, static_cast<Session*>(&w), on_write, on_flush);
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(w.width), static_cast<png_uint_32>(w.height),
               w.bits, w.colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  // Recorded frames are the most of what is written, and have a frame's time: a third of the time
  // of zlib's default level, for files a tenth larger.
  png_set_compression_level(w.png, 1);
  png_set_filter(w.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(w.png, w.info);
  if (w.bits == 16 && std::endian::native == std::endian::little) png_set_swap(w.png);
  png_write_image(w.png, w.rows.data());
  png_write_end(w.png, nullptr);
}

// row(y) gives the tight bytes of a row.
template <class Row>
Result<std::vector<std::uint8_t>> encode(int width, int height, int channels, int bits, Row row) {
  Writer writer;
  if (writer.info == nullptr) return Error{"no memory for writing a PNG"};
  writer.width = width;
  writer.height = height;
  writer.bits = bits;
  writer.colour_type = channels == 1   ? PNG_COLOR_TYPE_GRAY
                       : channels == 3 ? PNG_COLOR_TYPE_RGB
                                       : PNG_COLOR_TYPE_RGB_ALPHA;
  for (int y = 0; y < height; ++y) writer.rows.push_back(const_cast<png_bytep>(row(y)));
  if (!run(writer, write_all)) return Error{"cannot write a PNG: " + writer.error};
  return std::move(writer.out);
}

template <class Sample>
Result<std::vector<std::uint8_t>> encode_raster(const Raster<Sample>& raster) {
  const bool fits = raster.width > 0 && raster.height > 0 &&
                    (raster.channels == 1 || raster.channels == 3 || raster.channels == 4) &&
                    raster.samples.size() == static_cast<std::size_t>(raster.width) *
                                                 static_cast<std::size_t>(raster.height) *
                                                 static_cast<std::size_t>(raster.channels);
  if (!fits) return Error{"cannot write a PNG: size and samples do not fit together"};
  return encode(raster.width, raster.height, raster.channels, 8 * static_cast<int>(sizeof(Sample)),
                [&](int y) { return reinterpret_cast<const png_byte*>(raster.at(0, y)); });
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 8 && png_sig_cmp(bytes.data(), 0, 8) == 0;
}

Result<hal::Image> decode_png(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  const Result<Header> header = reader.read_header();
  if (!header) return header.error();
  hal::Image image(header->width, header->height, hal::PixelFormat::kRgb24);
  const Result<void> done = reader.read_pixels(*header, 3, 8, image.plane(0));
  if (!done) return done.error();
  return image;
}

Result<Raster8> decode_png8(std::span<const std::uint8_t> bytes, int channels) {
  return decode<std::uint8_t>(bytes, channels);
}

Result<Raster16> decode_png16(std::span<const std::uint8_t> bytes, int channels) {
  return decode<std::uint16_t>(bytes, channels);
}

Result<std::vector<std::uint8_t>> encode_png(const Raster8& raster) {
  return encode_raster(raster);
}

Result<std::vector<std::uint8_t>> encode_png(const Raster16& raster) {
  return encode_raster(raster);
}

Result<std::vector<std::uint8_t>> encode_png(const hal::ImageView& view) {
  if (!hal::is_complete(view)) return Error{"cannot write a PNG: the image has no pixels"};
  if (view.format != hal::PixelFormat::kRgb24) return encode_png(hal::to_rgb24(view).view());
  return encode(view.width, view.height, 3, 8,
                [&](int y) { return view.plane[0] + std::ptrdiff_t{y} * view.stride[0]; });
}

}  // namespace gannet::image_file

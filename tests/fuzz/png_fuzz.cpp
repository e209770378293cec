// Any bytes as a PNG, in each way that we read one. libFuzzer, and mutation_test.cpp in `make
// check`.
#include <cstddef>
#include <cstdint>

#include "src/image_file/png.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gannet::image_file;
  const std::span<const std::uint8_t> bytes(data, size);
  const auto rgb = decode_png(bytes);
  const auto rgba = decode_png8(bytes, 4);
  const auto grey = decode_png8(bytes, 1);
  const auto deep = decode_png16(bytes);
  // All ways see the same file: it is good or it is not. What is good can be written again.
  const bool good = rgb.has_value();
  if (rgba.has_value() != good || grey.has_value() != good || deep.has_value() != good)
    __builtin_trap();
  if (good && !encode_png(rgb->view())) __builtin_trap();
  return 0;
}

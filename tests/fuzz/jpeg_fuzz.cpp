// Any bytes as a JPEG. libFuzzer, and mutation_test.cpp in `make check`.
#include <cstddef>
#include <cstdint>

#include "src/image_file/jpeg.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gannet;
  const auto image = image_file::decode_jpeg({data, size});
  if (image && (!hal::is_complete(image->view()) || !image_file::encode_jpeg(image->view(), 50)))
    __builtin_trap();
  if (!image && image.error().text.empty()) __builtin_trap();
  return 0;
}

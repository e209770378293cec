// A hostile writer: any bytes over the header and the slots' words of shared frames. The reader
// refuses the file, or gives pairs whose pixels lie within it and whose numbers rise.
// libFuzzer, and mutation_test.cpp in `make check`.
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hal/camera/shared_frames.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gannet;
  using namespace gannet::hal;
  static const std::string name = "gannet-fuzz-" + std::to_string(::getpid());
  SharedFramesFormat format;
  format.width = 8;
  format.height = 4;
  auto writer = SharedFramesWriter::create(name, format);
  auto memory = linux_os::MappedMemory::open(name, true);
  if (!writer || !memory || size == 0) return 0;
  // An even first byte leaves the header good, so that the slots are reached.
  const std::size_t from = data[0] % 2 == 0 ? sizeof(SharedHeader) : 0;
  std::memcpy(memory->data() + from, data + 1, std::min(size - 1, memory->size() - from));
  auto reader = SharedFramesReader::open(name);
  if (!reader) return 0;
  std::uint64_t last = 0;
  StereoFrame frame;
  for (int i = 0; i < 20; ++i) {
    const auto now = time_from_ns(i < 10 ? std::int64_t{1} << (6 * i) : INT64_MAX);
    if ((*reader)->take(now, frame) != CaptureStatus::kFrame) continue;
    if (frame.number <= last || frame.capture_time > now) __builtin_trap();
    last = frame.number;
    // Reads the last bytes: a sanitizer or the kernel stops us if they are not there.
    volatile std::uint8_t sum = 0;
    for (const ImageView* view : {&frame.left, &frame.right})
      sum = static_cast<std::uint8_t>(sum + view->plane[0][view->stride[0] * view->height - 1]);
  }
  frame = StereoFrame{};
  return 0;
}

// Any text as a times.csv. libFuzzer, and mutation_test.cpp in `make check`.
#include <cstddef>
#include <cstdint>

#include "hal/camera/frame_directory.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto rows =
      gannet::hal::parse_frame_times("times.csv", {reinterpret_cast<const char*>(data), size});
  for (std::size_t i = 1; rows && i < rows->size(); ++i)
    if (!((*rows)[i].time_s > (*rows)[i - 1].time_s)) __builtin_trap();
  return 0;
}

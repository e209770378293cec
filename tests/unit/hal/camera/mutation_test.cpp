// The fuzz targets of this room on a few hundred mutated inputs: a target traps if it is wrong.
#include <gtest/gtest.h>

#include <string>

#include "tests/fuzz/mutate.hpp"

#define LLVMFuzzerTestOneInput fuzz_shared_frames
#include "tests/fuzz/shared_frames_fuzz.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_frame_times
#include "tests/fuzz/frame_times_fuzz.cpp"
#undef LLVMFuzzerTestOneInput

namespace gannet::hal {
namespace {

// The head of a good file with two published pairs, behind the target's first byte.
std::vector<std::uint8_t> head(std::uint8_t mode) {
  const std::string name = "gannet-head-" + std::to_string(::getpid());
  auto writer = SharedFramesWriter::create(name, {.width = 8, .height = 4});
  for (int i = 1; i <= 2; ++i) {
    writer->begin_frame();
    writer->publish(time_from_ns(i), time_from_ns(i));
  }
  const auto memory = linux_os::MappedMemory::open(name, true);
  const std::size_t from = mode % 2 == 0 ? sizeof(SharedHeader) : 0;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(memory->data());
  std::vector<std::uint8_t> input(1 + sizeof(SharedHeader) + 8 * sizeof(SharedSlot) - from);
  input[0] = mode;
  std::memcpy(input.data() + 1, bytes + from, input.size() - 1);
  return input;
}

TEST(Mutation, no_writer_however_hostile_does_harm) {
  run_mutations({head(0), head(1)}, 400, fuzz_shared_frames);
}

TEST(Mutation, no_times_file_however_broken_does_harm) {
  const std::string good = "frame,time_s\n0001,0.5\r\nleft_2, 1.25\n\n3,7e2\n";
  run_mutations({{good.begin(), good.end()}}, 2000, fuzz_frame_times);
}

}  // namespace
}  // namespace gannet::hal

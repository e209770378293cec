// The bare loads that no evaluation can do without (method §5): the same cells at ready-made
// indices that are read from memory, summed. Benchmarks only, one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gannet::bench {

// Four sums, so that the additions never wait for each other.
template <class Cell>
std::uint32_t bare_loads(const Cell* cells, const std::vector<std::int32_t>& index) {
  std::uint32_t a = 0, b = 0, c = 0, d = 0;
  const std::int32_t* at = index.data();
  for (std::size_t i = 0; i + 4 <= index.size(); i += 4) {  // padded to a multiple of 16
    a += cells[at[i]];
    b += cells[at[i + 1]];
    c += cells[at[i + 2]];
    d += cells[at[i + 3]];
  }
  return a + b + c + d;
}

}  // namespace gannet::bench

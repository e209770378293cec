// The count that count_heap.hpp keeps: for the other sources of a test binary that has one with it.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GANNET_COUNTS_HEAP 0
#else
#define GANNET_COUNTS_HEAP 1
#endif

namespace gannet::test {

inline thread_local std::uint64_t heap_calls = 0;
inline constexpr bool kCountsHeap = GANNET_COUNTS_HEAP == 1;

}  // namespace gannet::test

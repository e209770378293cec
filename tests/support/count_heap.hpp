// Counts heap calls of this thread, to prove that a call makes none. Included by one source of a
// test binary, once. Under the sanitizers, which bring their own heap, it counts nothing and says
// so.
#pragma once

#include "tests/support/heap_calls.hpp"

#if GANNET_COUNTS_HEAP
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* old);

void* malloc(std::size_t size) noexcept {
  ++gannet::test::heap_calls;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++gannet::test::heap_calls;
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) noexcept {
  ++gannet::test::heap_calls;
  return __libc_realloc(old, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++gannet::test::heap_calls;
  return __libc_memalign(alignment, size);
}
void free(void* old) noexcept { __libc_free(old); }
}
#endif

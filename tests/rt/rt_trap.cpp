#include "tests/rt/rt_trap.hpp"

#include <execinfo.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>

namespace gannet::test {
namespace {

thread_local int depth = 0;
std::atomic<int> calls{0};

[[maybe_unused]] void caught() {
  if (depth == 0) return;
  const int before = depth;
  depth = 0;  // the trace may allocate itself
  if (calls.fetch_add(1) < 3) {
    void* frames[32];
    backtrace_symbols_fd(frames, backtrace(frames, 32), STDERR_FILENO);
    [[maybe_unused]] const auto n = write(STDERR_FILENO, "----\n", 5);
  }
  depth = before;
}

}  // namespace

int trapped_calls() { return calls.load(); }
RtSection::RtSection() { ++depth; }
RtSection::~RtSection() { --depth; }

}  // namespace gannet::test

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
bool gannet::test::trap_works() { return false; }
#else
bool gannet::test::trap_works() { return true; }

// glibc's own entries below its public names.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  gannet::test::caught();
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  gannet::test::caught();
  return __libc_calloc(n, size);
}
void* realloc(void* old, std::size_t size) {
  gannet::test::caught();
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  gannet::test::caught();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  gannet::test::caught();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  gannet::test::caught();
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? 12 : 0;
}
void free(void* memory) {
  gannet::test::caught();
  __libc_free(memory);
}
}
#endif

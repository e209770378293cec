// Sleeping on a word of memory until another thread or process changes it and wakes us. The usual
// order: read the word, look for work, then wait with the value read, so that no wake-up is lost.
// RT safe: one system call, none when the word has changed already.
#pragma once

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <cstdint>

#include "platform/base/time.hpp"

namespace gannet::linux_os {

using FutexWord = std::atomic<std::uint32_t>;
static_assert(sizeof(FutexWord) == 4 && FutexWord::is_always_lock_free);

// Returns when woken, when the word is no longer `seen`, at `until` (CLOCK_MONOTONIC), or for no
// reason at all. The word may lie in memory shared with another process.
inline void futex_wait(const FutexWord& word, std::uint32_t seen, TimePoint until) {
  const std::int64_t ns = to_ns(until) < 0 ? 0 : to_ns(until);
  const timespec deadline = {static_cast<time_t>(ns / 1'000'000'000),
                             static_cast<long>(ns % 1'000'000'000)};
  syscall(SYS_futex, &word, FUTEX_WAIT_BITSET, seen, &deadline, nullptr, FUTEX_BITSET_MATCH_ANY);
}

inline void futex_wake_all(const FutexWord& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace gannet::linux_os

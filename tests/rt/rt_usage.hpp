// What the kernel counts of the calling thread: page faults and voluntary switches.
#pragma once

#include <sys/resource.h>

namespace gannet::test {

// A sanitizer's shadow memory faults pages in whenever it likes.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kCountsPageFaults = false;
#else
inline constexpr bool kCountsPageFaults = true;
#endif

struct RtUsage {
  long page_faults = 0;
  long voluntary_switches = 0;

  static RtUsage now() {
    rusage usage = {};
    getrusage(RUSAGE_THREAD, &usage);
    return {usage.ru_minflt + usage.ru_majflt, usage.ru_nvcsw};
  }
  RtUsage since(const RtUsage& before) const {
    return {page_faults - before.page_faults, voluntary_switches - before.voluntary_switches};
  }
};

}  // namespace gannet::test

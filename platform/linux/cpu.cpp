#include "platform/linux/cpu.hpp"

#include <sched.h>

namespace gannet::linux_os {
namespace {

cpu_set_t allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  sched_getaffinity(0, sizeof set, &set);
  return set;
}

}  // namespace

CpuFeatures cpu_features() {
  CpuFeatures features;
#if defined(__x86_64__)
  __builtin_cpu_init();
  // These also ask whether the kernel saves the wide registers (XGETBV).
  features.avx2 = __builtin_cpu_supports("avx2") != 0;
  features.avx512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
      __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512vnni") != 0;
#elif defined(__aarch64__)
  features.neon = true;  // part of every 64-bit ARM
#endif
  return features;
}

int core_count() {
  const cpu_set_t set = allowed_cores();
  const int count = CPU_COUNT(&set);
  return count > 0 ? count : 1;
}

bool may_run_on(int core) {
  const cpu_set_t set = allowed_cores();
  return core >= 0 && core < CPU_SETSIZE && CPU_ISSET(static_cast<unsigned>(core), &set);
}

}  // namespace gannet::linux_os

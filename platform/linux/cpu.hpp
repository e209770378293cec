// What the processor can do, asked at run time. Start-up only.
#pragma once

namespace gannet::linux_os {

struct CpuFeatures {
  bool avx2 = false;
  bool avx512 = false;  // F, BW, VL and VNNI, all of them and enabled by the kernel
  bool neon = false;
};

CpuFeatures cpu_features();

// The cores that this process may run on, not those that the machine has.
int core_count();
bool may_run_on(int core);

}  // namespace gannet::linux_os

#include "src/vision/kernels/refine_sums.hpp"

namespace gannet::vision {

const RefineKernels& refine_kernels() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2")) return kAvx2RefineKernels;
#endif
  return kScalarRefineKernels;
}

}  // namespace gannet::vision

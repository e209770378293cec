#include "src/vision/kernel_choice.hpp"

#include <array>

namespace gannet::vision {

std::span<const Kernels* const> kernels_here() {
#if defined(__x86_64__)
  static const std::array<const Kernels*, 3> all = {&kScalarKernels, &kAvx2Kernels,
                                                    &kAvx512Kernels};
  __builtin_cpu_init();
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512vnni");
  const bool avx2 = __builtin_cpu_supports("avx2");
  const std::size_t count = avx2 ? avx512 ? 3 : 2 : 1;
#elif defined(__aarch64__)
  static const std::array<const Kernels*, 2> all = {&kScalarKernels, &kNeonKernels};
  const std::size_t count = 2;
#else
  static const std::array<const Kernels*, 1> all = {&kScalarKernels};
  const std::size_t count = 1;
#endif
  return std::span<const Kernels* const>(all.data(), count);
}

const Kernels* find_kernels(std::string_view name) {
  const auto all = kernels_here();
  if (name.empty() || name == "auto") return all.back();
  for (const Kernels* k : all) {
    if (name == k->name) return k;
  }
  return nullptr;
}

}  // namespace gannet::vision

#include "platform/linux/cpu.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace gannet::linux_os {
namespace {

TEST(Cpu, agrees_with_the_kernel) {
  std::stringstream text;
  text << std::ifstream("/proc/cpuinfo").rdbuf();
  const CpuFeatures sut = cpu_features();
#if defined(__x86_64__)
  EXPECT_EQ(sut.avx2, text.str().find(" avx2 ") != std::string::npos);
  EXPECT_EQ(sut.avx512, text.str().find("avx512_vnni") != std::string::npos);
#else
  EXPECT_FALSE(sut.avx2);
#endif
}

TEST(Cpu, counts_the_cores_that_it_may_use) {
  int count = 0;
  for (int core = 0; core < 1024; ++core) count += may_run_on(core) ? 1 : 0;
  EXPECT_EQ(core_count(), count);
  EXPECT_FALSE(may_run_on(-1));
  EXPECT_FALSE(may_run_on(100000));
}

}  // namespace
}  // namespace gannet::linux_os

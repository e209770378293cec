// gannet: the person's tool. What it can do stands in subcommands.cpp.
#include <cstdio>
#include <string>
#include <vector>

#include "src/tool/subcommands.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> args(argv + 1, argv + argc);
  const int code = gannet::tool::run_gannet(args);
  // An answer that never reached its reader (a full disk) is no success.
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  std::perror("gannet: standard output");
  return 2;
}

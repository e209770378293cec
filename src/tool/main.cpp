// gannet: the person's tool. What it can do stands in subcommands.cpp.
#include <string>
#include <vector>

#include "src/tool/subcommands.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> args(argv + 1, argv + argc);
  return gannet::tool::run_gannet(args);
}

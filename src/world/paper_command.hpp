// `gannet-world paper …`: runs one experiment of the papers, or tells which there are and how all
// of them are run. Exit codes: 0 done, whatever its figures are; 2 bad words; 3 the run broke off.
// Start-up only, the main thread.
#pragma once

#include <span>
#include <string>

#include "platform/base/command_line.hpp"

namespace gannet::world {

Command paper_command();
// args without "gannet-world paper".
int run_paper_command(const std::string& program, std::span<const std::string> args);

}  // namespace gannet::world

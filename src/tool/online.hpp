// Subcommands that talk to a running daemon over its control socket. Exit 1 where the daemon
// refuses, 2 where nobody serves the socket or the request is wrong. Normal thread.
#pragma once

#include <vector>

#include "src/tool/subcommands.hpp"

namespace gannet::tool {

std::vector<Subcommand> online_subcommands();

}  // namespace gannet::tool

// The subcommands of `gannet`, as one table. Each has its description, from which parser, help and
// man page are made, and what it does. Exit codes: 0 done (or found), 1 not found or refused by
// the daemon, 2 bad input. Normal thread.
#pragma once

#include <span>
#include <string>

#include "platform/base/command_line.hpp"

namespace gannet::tool {

struct Subcommand {
  Command command;  // its name begins with "gannet "
  int (*run)(const Arguments& arguments);
  // Standard output when args cannot be parsed, or null: for commands whose answer is a document.
  void (*tell_bad_arguments)(std::span<const std::string> args, const std::string& text) = nullptr;
};

std::span<const Subcommand> subcommands();

// The whole program: args without its name. Returns the exit code.
int run_gannet(std::span<const std::string> args);

}  // namespace gannet::tool

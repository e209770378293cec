// What the parser of command lines and its help both say of words and numbers. Start-up only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/command_line.hpp"

namespace gannet {

std::vector<std::string> split(std::string_view text, char at);
std::string joined(const std::vector<std::string>& words, std::string_view between);

// "10 to 10000", "at least 10"; "" where every number is allowed.
std::string range_text(const Argument& a);

}  // namespace gannet

// Values as TOML text, and the words that help, reference and errors share. Start-up only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/describe.hpp"

namespace gannet::config {

// The shortest text that reads back to the same number; no locale, no exponent where people can
// do without.
std::string number_text(double number);

std::string toml_string(std::string_view text);  // a TOML basic string
std::string joined(const std::vector<std::string>& words, std::string_view between);

std::string value_text(bool value);
std::string value_text(int value);
std::string value_text(double value);
std::string value_text(const std::string& value);
std::string value_text(const std::vector<double>& values);
std::string value_text(const std::vector<int>& values);
std::string value_text(const std::vector<std::string>& values);

std::string interval_text(const About& about);  // "[4, 4096]", "[0, ∞)", "" without limits
std::string facts_text(const About& about);     // "Hz; 4 … 4096"; choices; array length

// Lines of at most 96 columns, each begun with prefix.
std::string wrapped(std::string_view text, std::string_view prefix);

}  // namespace gannet::config

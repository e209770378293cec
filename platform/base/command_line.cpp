#include "platform/base/command_line.hpp"

#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "platform/base/command_words.hpp"

namespace gannet {

const std::vector<std::string>& Arguments::values(std::string_view name) const {
  const auto found = values_.find(name);
  assert(found != values_.end());
  return found->second;
}

bool Arguments::given(std::string_view name) const {
  const auto found = given_.find(name);
  assert(found != given_.end());
  return found->second;
}

std::string Arguments::text(std::string_view name) const {
  return values(name).empty() ? "" : values(name).front();
}

std::vector<std::string> Arguments::texts(std::string_view name) const { return values(name); }

double Arguments::number(std::string_view name) const {
  assert(!values(name).empty());
  return *number_from_text(values(name).front());
}

int Arguments::integer(std::string_view name) const {
  assert(!values(name).empty());
  return *integer_from_text(values(name).front());
}

std::vector<double> Arguments::numbers(std::string_view name) const {
  if (values(name).empty()) return {};
  const std::string& text = values(name).front();
  std::vector<double> numbers;
  // The table is not here: whichever separator the value has is the one that it was checked with.
  for (const std::string& part : split(text, text.find(':') != std::string::npos ? ':' : ','))
    numbers.push_back(*number_from_text(part));
  return numbers;
}

std::vector<int> Arguments::integers(std::string_view name) const {
  std::vector<int> integers;
  for (const double number : numbers(name)) integers.push_back(static_cast<int>(number));
  return integers;
}

std::optional<double> number_from_text(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  if (!std::isfinite(number)) return {};
  return number;
}

std::optional<int> integer_from_text(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
  return number;
}

std::optional<int> begin_command(const Command& command, std::span<const std::string> args,
                                 Arguments& arguments) {
  for (const std::string& text : args) {
    std::string answer;
    if (text == "--help" || text == "-h") answer = help_text(command);
    if (text == "--version") answer = command.name + " " + GANNET_VERSION + "\n";
    if (text == "--man-page") answer = man_page(command);
    if (text == "--") break;
    if (answer.empty()) continue;
    std::fputs(answer.c_str(), stdout);
    return 0;
  }
  Result<Arguments> parsed = parse(command, args);
  if (!parsed) {
    std::fprintf(stderr, "%s\n", parsed.error().text.c_str());
    return 2;
  }
  arguments = std::move(*parsed);
  return std::nullopt;
}

}  // namespace gannet

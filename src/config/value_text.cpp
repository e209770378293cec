#include "src/config/value_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gannet::config {
namespace {

template <class T>
std::string array_text(const std::vector<T>& values) {
  std::vector<std::string> texts;
  for (const T& value : values) texts.push_back(value_text(value));
  return "[" + joined(texts, ", ") + "]";
}

}  // namespace

std::string number_text(double number) {
  char text[400];
  const double size = std::abs(number);
  const bool plain = number == 0 || (size >= 1e-5 && size < 1e15);
  const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
  return {text, std::to_chars(text, text + sizeof text, number, format).ptr};
}

std::string toml_string(std::string_view text) {
  static const char* kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7f) {
      out += std::string("\\u00") + kHex[byte >> 4] + kHex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += between;
    text += words[i];
  }
  return text;
}

std::string value_text(bool value) { return value ? "true" : "false"; }
std::string value_text(int value) { return std::to_string(value); }
std::string value_text(const std::string& value) { return toml_string(value); }
std::string value_text(const std::vector<double>& values) { return array_text(values); }
std::string value_text(const std::vector<int>& values) { return array_text(values); }
std::string value_text(const std::vector<std::string>& values) { return array_text(values); }

// A float keeps its point, so that its kind can be seen.
std::string value_text(double value) {
  const std::string text = number_text(value);
  const bool whole = text.find_first_not_of("-0123456789") == std::string::npos;
  return whole ? text + ".0" : text;
}

std::string interval_text(const About& about) {
  const bool low = std::isfinite(about.min);
  const bool high = std::isfinite(about.max);
  if (!low && !high) return "";
  return (low ? "[" + number_text(about.min) : std::string("(−∞")) + ", " +
         (high ? number_text(about.max) + "]" : std::string("∞)"));
}

std::string facts_text(const About& about) {
  std::vector<std::string> facts;
  if (!about.unit.empty()) facts.emplace_back(about.unit);
  const bool low = std::isfinite(about.min);
  const bool high = std::isfinite(about.max);
  if (low && high) facts.push_back(number_text(about.min) + " … " + number_text(about.max));
  if (low && !high) facts.push_back("at least " + number_text(about.min));
  if (high && !low) facts.push_back("at most " + number_text(about.max));
  if (about.size >= 0) facts.push_back(std::to_string(about.size) + " elements");
  if (!about.choices.empty()) facts.push_back("one of " + joined(about.choices, ", "));
  return joined(facts, "; ");
}

std::string wrapped(std::string_view text, std::string_view prefix) {
  const std::size_t width = 96;
  const auto columns = [](std::string_view word) {  // UTF-8: continuation bytes take none
    return static_cast<std::size_t>(
        std::count_if(word.begin(), word.end(), [](char c) { return (c & 0xc0) != 0x80; }));
  };
  std::string out;
  std::size_t column = width;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    if (column + 1 + columns(word) > width) {
      out += (out.empty() ? "" : "\n") + std::string(prefix);
      column = prefix.size();
    } else {
      out += ' ';
      ++column;
    }
    out += word;
    column += columns(word);
  }
  return out.empty() ? out : out + "\n";
}

}  // namespace gannet::config

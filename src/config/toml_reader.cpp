#include "src/config/toml_reader.hpp"

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace gannet::config {
namespace {

using Kind = TomlValue::Kind;

TomlValue convert(const toml::node& node);

TomlValue convert_table(const toml::table& table) {
  TomlValue value;
  for (const auto& [key, member] : table)
    value.members.emplace_back(convert(member)).name = std::string(key.str());
  // toml++ sorts by name; people think in lines.
  std::stable_sort(value.members.begin(), value.members.end(),
                   [](const auto& a, const auto& b) { return a.line < b.line; });
  return value;
}

TomlValue convert(const toml::node& node) {
  TomlValue value;
  if (const toml::table* table = node.as_table()) {
    value = convert_table(*table);
  } else if (const toml::array* array = node.as_array()) {
    value.kind = Kind::kArray;
    for (const toml::node& element : *array) value.elements.push_back(convert(element));
  } else if (const auto* text = node.as_string()) {
    value.kind = Kind::kText;
    value.text = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.kind = Kind::kInteger;
    value.integer = integer->get();
    value.number = static_cast<double>(integer->get());
  } else if (const auto* number = node.as_floating_point()) {
    value.kind = Kind::kNumber;
    value.number = number->get();
  } else if (const auto* boolean = node.as_boolean()) {
    value.kind = Kind::kBoolean;
    value.boolean = boolean->get();
  } else {
    value.kind = Kind::kTime;
  }
  value.line = static_cast<int>(node.source().begin.line);
  return value;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  return line;
}

}  // namespace

const TomlValue* TomlValue::find(std::string_view key) const {
  for (const TomlValue& member : members)
    if (member.name == key) return &member;
  return nullptr;
}

const char* to_string(Kind kind) {
  switch (kind) {
    case Kind::kTable:
      return "a table";
    case Kind::kArray:
      return "an array";
    case Kind::kText:
      return "a string";
    case Kind::kInteger:
      return "a whole number";
    case Kind::kNumber:
      return "a number";
    case Kind::kBoolean:
      return "true or false";
    case Kind::kTime:
      return "a date or time";
  }
  return "?";
}

Result<TomlValue> parse_toml(std::string_view text, const std::string& name) {
  const toml::parse_result parsed = toml::parse(text, name);
  if (parsed) return convert_table(parsed.table());
  const toml::parse_error& error = parsed.error();
  return Error{name + ":" + std::to_string(error.source().begin.line) +
               ": not valid TOML: " + one_line(error.description())};
}

Result<TomlValue> read_toml(const std::string& path) {
  constexpr std::size_t kLargest = std::size_t{1} << 20;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "re"),
                                                             &std::fclose);
  if (!file) return Error{path + ": cannot be opened: " + std::strerror(errno)};
  std::string text(kLargest + 1, '\0');
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get()) != 0)
    return Error{path + ": cannot be read: " + std::strerror(errno)};
  if (text.size() > kLargest)
    return Error{path + ": is larger than 1 MiB; is this the right file?"};
  return parse_toml(text, path);
}

}  // namespace gannet::config

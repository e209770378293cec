// TOML text as a plain tree in which each value knows its line. The only file pair that knows
// toml++, so that the parser can be replaced and its compile time is paid once. Start-up only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::config {

struct TomlValue {
  enum class Kind { kTable, kArray, kText, kInteger, kNumber, kBoolean, kTime };

  Kind kind = Kind::kTable;
  std::string name;  // its key, when it is a table's member
  int line = 0;      // from 1; 0: not from a file
  std::string text;
  std::int64_t integer = 0;
  double number = 0;  // of kInteger too
  bool boolean = false;
  std::vector<TomlValue> members;   // of a table, in the order of lines
  std::vector<TomlValue> elements;  // of an array

  const TomlValue* find(std::string_view key) const;  // null when the table has no such member
};

const char* to_string(TomlValue::Kind kind);  // "a table", "a whole number" …

// name stands for the file in errors: "demo.toml:3: …". A syntax error ends the reading, so there
// is at most one; a key that stands twice is one.
Result<TomlValue> parse_toml(std::string_view text, const std::string& name);

// Errors: no such file, not readable, larger than a mebibyte, and parse_toml's.
Result<TomlValue> read_toml(const std::string& path);

}  // namespace gannet::config

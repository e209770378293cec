#include "src/config/loader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/base/nearest_word.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {

using Kind = TomlValue::Kind;

Loader::Loader(const TomlValue& root, const std::string& source, Origins& origins,
               Problems& problems)
    : levels_{{&root, "", {}}}, source_(source), origins_(origins), problems_(problems) {
  int format = 1;
  field("format", format, {.help = "The format of the file."});
  if (format != 1)
    refuse(*root.find("format"), "format",
           std::to_string(format) + " is not known; this program reads format 1");
  origins_.erase("format");
}

std::string Loader::path_of(std::string_view name) const {
  return levels_.back().path + std::string(name);
}

// Null when the file does not say it.
const TomlValue* Loader::take(std::string_view name) {
  levels_.back().known.emplace_back(name);
  const TomlValue* value = levels_.back().table->find(name);
  if (value != nullptr) origins_[path_of(name)] = {source_, value->line};
  return value;
}

void Loader::refuse(const TomlValue& value, std::string_view name, const std::string& text) {
  problems_.add({source_, value.line}, path_of(name) + ": " + text);
}

bool Loader::check_kind(const TomlValue& value, std::string_view name, Kind wanted) {
  const bool whole_for_number = wanted == Kind::kNumber && value.kind == Kind::kInteger;
  if (value.kind == wanted || whole_for_number) return true;
  refuse(value, name,
         std::string("expects ") + to_string(wanted) + ", found " + to_string(value.kind));
  return false;
}

bool Loader::check_number(const TomlValue& value, std::string_view name, const About& about) {
  if (!std::isfinite(value.number)) {
    refuse(value, name, "is not a finite number");
    return false;
  }
  if (value.number >= about.min && value.number <= about.max) return true;
  const std::string unit = about.unit.empty() ? "" : " " + std::string(about.unit);
  refuse(value, name, number_text(value.number) + unit + " is outside " + interval_text(about));
  return false;
}

bool Loader::read(const TomlValue& value, std::string_view name, int& to, const About& about) {
  if (!check_kind(value, name, Kind::kInteger) || !check_number(value, name, about)) return false;
  if (value.integer < std::numeric_limits<int>::min() ||
      value.integer > std::numeric_limits<int>::max()) {
    refuse(value, name, std::to_string(value.integer) + " is too large a number");
    return false;
  }
  to = static_cast<int>(value.integer);
  return true;
}

bool Loader::read(const TomlValue& value, std::string_view name, double& to, const About& about) {
  if (!check_kind(value, name, Kind::kNumber) || !check_number(value, name, about)) return false;
  to = value.number;
  return true;
}

bool Loader::read(const TomlValue& value, std::string_view name, std::string& to,
                  const About& about) {
  if (!check_kind(value, name, Kind::kText)) return false;
  const auto& choices = about.choices;
  if (!choices.empty() && std::find(choices.begin(), choices.end(), value.text) == choices.end()) {
    refuse(value, name,
           toml_string(value.text) + " is none of " + joined(choices, ", ") +
               did_you_mean(value.text, choices));
    return false;
  }
  to = value.text;
  return true;
}

template <class T>
void Loader::read_array(std::string_view name, std::vector<T>& to, const About& about) {
  const TomlValue* value = take(name);
  if (value == nullptr || !check_kind(*value, name, Kind::kArray)) return;
  const int size = static_cast<int>(value->elements.size());
  if (about.size >= 0 && size != about.size) {
    refuse(*value, name,
           "has " + std::to_string(size) + " elements instead of " + std::to_string(about.size));
    return;
  }
  std::vector<T> elements(value->elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string element_name = std::string(name) + "[" + std::to_string(i) + "]";
    if (!read(value->elements[i], element_name, elements[i], about)) return;
  }
  to = std::move(elements);
}

void Loader::field(std::string_view name, bool& to, const About&) {
  const TomlValue* value = take(name);
  if (value != nullptr && check_kind(*value, name, Kind::kBoolean)) to = value->boolean;
}

void Loader::field(std::string_view name, int& to, const About& about) {
  if (const TomlValue* value = take(name)) read(*value, name, to, about);
}

void Loader::field(std::string_view name, double& to, const About& about) {
  if (const TomlValue* value = take(name)) read(*value, name, to, about);
}

void Loader::field(std::string_view name, std::string& to, const About& about) {
  if (const TomlValue* value = take(name)) read(*value, name, to, about);
}

void Loader::field(std::string_view name, std::vector<double>& to, const About& about) {
  read_array(name, to, about);
}

void Loader::field(std::string_view name, std::vector<int>& to, const About& about) {
  read_array(name, to, about);
}

void Loader::field(std::string_view name, std::vector<std::string>& to, const About& about) {
  read_array(name, to, about);
}

bool Loader::enter_group(std::string_view name, std::string_view) {
  const TomlValue* value = take(name);
  if (value == nullptr || !check_kind(*value, name, Kind::kTable)) return false;
  levels_.push_back({value, path_of(name) + ".", {}});
  return true;
}

void Loader::leave_group() {
  refuse_unknown();
  levels_.pop_back();
}

int Loader::enter_list(std::string_view name, int, std::string_view) {
  static const TomlValue kNothing;
  const TomlValue* value = take(name);
  const std::string path = path_of(name);
  const bool usable = value != nullptr && check_kind(*value, name, Kind::kArray);
  levels_.push_back({usable ? value : &kNothing, path, {}});
  if (!usable) return -1;
  // What an earlier file said of the elements is gone with them.
  for (auto at = origins_.lower_bound(path + "["); at != origins_.end();) {
    if (at->first.compare(0, path.size() + 1, path + "[") != 0) break;
    at = origins_.erase(at);
  }
  return static_cast<int>(value->elements.size());
}

bool Loader::enter_element(int index) {
  const Level& list = levels_.back();
  const auto i = static_cast<std::size_t>(index);
  if (i >= list.table->elements.size()) return false;  // the list stays as it was
  const TomlValue& value = list.table->elements[i];
  const std::string name = "[" + std::to_string(index) + "]";
  if (!check_kind(value, name, Kind::kTable)) return false;
  origins_[path_of(name)] = {source_, value.line};
  levels_.push_back({&value, path_of(name) + ".", {}});
  return true;
}

void Loader::leave_element() { leave_group(); }
void Loader::leave_list() { levels_.pop_back(); }
void Loader::finish() { refuse_unknown(); }

void Loader::refuse_unknown() {
  const Level& level = levels_.back();
  for (const TomlValue& member : level.table->members) {
    const bool known =
        std::find(level.known.begin(), level.known.end(), member.name) != level.known.end();
    if (!known) refuse(member, member.name, "unknown key" + did_you_mean(member.name, level.known));
  }
}

}  // namespace gannet::config

// What is made of a description for people: the commented file, the list with origins, the
// reference as Markdown and as a manual page. Each takes a copy of the config, because a visitor
// may write. Start-up and control thread.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "platform/base/describe.hpp"
#include "src/config/loader.hpp"

namespace gannet::config {

// A visitor that makes a text.
class Printer {
 public:
  virtual ~Printer() = default;
  virtual Visitor& visitor() = 0;
  virtual std::string text() = 0;  // after the visit
};

std::unique_ptr<Printer> make_file_printer();
std::unique_ptr<Printer> make_origin_printer(const Origins& origins);  // borrowed
std::unique_ptr<Printer> make_markdown_printer();
std::unique_ptr<Printer> make_man_printer();

template <class Config>
std::string print(std::unique_ptr<Printer> printer, Config config) {
  describe(printer->visitor(), config);
  return printer->text();
}

// A TOML file with every key, its meaning above it; loads back to the same values. Lists that are
// empty are shown as a comment, with one element to copy.
template <class Config>
std::string commented_file(const Config& config) {
  return print(make_file_printer(), config);
}

// "search.population = 60  # gannet.toml:12" for each key, or "# built-in".
template <class Config>
std::string values_with_origins(const Config& config, const Origins& origins) {
  return print(make_origin_printer(origins), config);
}

// A section for each table, a row for each key.
template <class Config>
std::string markdown_reference(const Config& config) {
  return print(make_markdown_printer(), config);
}

// The same as roff, for the middle of a page of section 5.
template <class Config>
std::string man_reference(const Config& config) {
  return print(make_man_printer(), config);
}

}  // namespace gannet::config

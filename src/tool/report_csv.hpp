// CsvTable: a recorded table as gannet-world writes it: a header, then rows of as many cells; the
// last cell takes what is left of its line. Cells are not quoted. Error: file:line. Normal thread.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"

namespace gannet::tool {

class CsvTable {
 public:
  // path is for errors alone; any text may be given.
  static Result<CsvTable> parse(const std::string& path, const std::string& text);
  static Result<CsvTable> read(const std::string& path);

  bool has(std::string_view column) const;
  std::size_t rows() const { return rows_.size(); }
  // Error: no such column.
  Result<std::vector<std::string>> texts(std::string_view column) const;
  // Error: no such column, or a cell that is no number.
  Result<std::vector<double>> numbers(std::string_view column) const;

 private:
  std::string path_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace gannet::tool

// Table: rows of words and numbers, as aligned text for terminals; reports take the same table
// (html_report.hpp). Columns whose cells are all numbers are set right. Any thread; a value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gannet::report {

class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}

  // Missing cells are empty, surplus ones are dropped.
  void add(std::vector<std::string> row);

  const std::vector<std::string>& header() const { return header_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }
  bool is_numeric(std::size_t column) const;

  // Header, a rule and the rows, each line ended; two spaces between columns, none at line ends.
  std::string text() const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

// Fixed decimals, without locale: number(1.26, 1) is "1.3"; not a number gives "–".
std::string number(double value, int decimals);

// Columns that UTF-8 text takes on a terminal, one for each code point.
int text_width(std::string_view text);

}  // namespace gannet::report

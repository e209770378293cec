#include "src/report/table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace gannet::report {
namespace {

// A digit, and nothing but what numbers, intervals and units of percent are made of.
bool looks_numeric(std::string_view cell) {
  if (cell == "–" || cell == "-" || cell.empty()) return true;
  const bool digit = cell.find_first_of("0123456789") != std::string_view::npos;
  return digit && cell.find_first_not_of("0123456789+-.,eE%() ×±") == std::string_view::npos;
}

std::string padded(const std::string& cell, int width, bool right) {
  const std::string space(static_cast<std::size_t>(std::max(width - text_width(cell), 0)), ' ');
  return right ? space + cell : cell + space;
}

}  // namespace

void Table::add(std::vector<std::string> row) {
  row.resize(header_.size());
  rows_.push_back(std::move(row));
}

bool Table::is_numeric(std::size_t column) const {
  bool any = false;
  for (const auto& row : rows_) {
    if (!looks_numeric(row[column])) return false;
    any = any || !row[column].empty();
  }
  return any;
}

std::string Table::text() const {
  std::vector<int> widths;
  for (std::size_t c = 0; c < header_.size(); ++c) {
    int width = text_width(header_[c]);
    for (const auto& row : rows_) width = std::max(width, text_width(row[c]));
    widths.push_back(width);
  }
  std::string result;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      text += (c > 0 ? "  " : "") + padded(cells[c], widths[c], is_numeric(c));
    }
    result += text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  };
  line(header_);
  std::vector<std::string> rule;
  for (const int width : widths) {
    std::string dashes;
    for (int i = 0; i < width; ++i) dashes += "─";
    rule.push_back(dashes);
  }
  line(rule);
  for (const auto& row : rows_) line(row);
  return result;
}

std::string number(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  char buffer[400];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed,
                                 std::clamp(decimals, 0, 12));
  const std::string text(buffer, end.ptr);
  // A rounded-away negative is plain zero.
  return text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1)
                                                                              : text;
}

int text_width(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
  }));
}

}  // namespace gannet::report

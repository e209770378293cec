#include "src/tool/report_csv.hpp"

#include <algorithm>

#include "platform/base/command_line.hpp"
#include "platform/linux/whole_file.hpp"

namespace gannet::tool {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 28;

// At most so many; the last one takes the rest.
std::vector<std::string> cells_of(std::string_view line, std::size_t most) {
  std::vector<std::string> cells;
  while (cells.size() + 1 < most) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) break;
    cells.emplace_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  cells.emplace_back(line);
  return cells;
}

}  // namespace

Result<CsvTable> CsvTable::parse(const std::string& path, const std::string& text) {
  CsvTable table;
  table.path_ = path;
  std::string_view rest = text;
  for (int line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (line_number == 1) {
      table.header_ = cells_of(line, line.size() + 1);
      continue;
    }
    std::vector<std::string> cells = cells_of(line, table.header_.size());
    if (cells.size() != table.header_.size())
      return Error{path + ":" + std::to_string(line_number) + ": has " +
                   std::to_string(cells.size()) + " cells, but the header has " +
                   std::to_string(table.header_.size())};
    table.rows_.push_back(std::move(cells));
  }
  if (table.header_.empty()) return Error{path + ": is empty"};
  return table;
}

Result<CsvTable> CsvTable::read(const std::string& path) {
  const auto bytes = linux_os::read_file(path, kMostBytes);
  if (!bytes) return bytes.error();
  return parse(path, std::string(bytes->begin(), bytes->end()));
}

bool CsvTable::has(std::string_view column) const {
  return std::find(header_.begin(), header_.end(), column) != header_.end();
}

Result<std::vector<std::string>> CsvTable::texts(std::string_view column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end())
    return Error{path_ + ":1: the column '" + std::string(column) + "' is missing"};
  const auto index = static_cast<std::size_t>(found - header_.begin());
  std::vector<std::string> cells;
  for (const auto& row : rows_) cells.push_back(row[index]);
  return cells;
}

Result<std::vector<double>> CsvTable::numbers(std::string_view column) const {
  const auto cells = texts(column);
  if (!cells) return cells.error();
  std::vector<double> values;
  for (const std::string& cell : *cells) {
    const auto value = number_from_text(cell);
    if (!value)
      return Error{path_ + ":" + std::to_string(values.size() + 2) + ": " + std::string(column) +
                   " is '" + cell + "', not a number"};
    values.push_back(*value);
  }
  return values;
}

}  // namespace gannet::tool

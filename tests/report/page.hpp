// Page: the contest's outcome as one HTML file of heat maps and tables, as JSON, and as a short
// table for the terminal. Nothing in them depends on how long anything took. Report only.
#pragma once

#include <string>

#include "tests/report/contest.hpp"

namespace gannet::robustness {

struct Findings {
  Contest contest;
  std::vector<std::string> notes;  // of the cast
  std::vector<Plane> planes;
  std::vector<std::vector<Cell>> cells;
};

Result<void> write_page(const Findings& findings, const std::string& path);
Result<void> write_json(const Findings& findings, const std::string& path);
std::string summary(const Findings& findings);  // all cells of a plane together

}  // namespace gannet::robustness

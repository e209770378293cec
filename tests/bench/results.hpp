// Results of one run: rows in groups, printed ratios first and written as JSON. Benchmarks only,
// one thread.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/measure.hpp"

namespace gannet::bench {

struct Ratio {
  std::string text;  // "times faster than reference"
  Spread value;
};

// What a figure shall be, and whether it is.
struct Goal {
  std::string text;  // "at most 1.5 times the bare loads"
  double measured = 0;
  bool reached = false;
};
Goal at_most(double limit, const std::string& what, double measured);
Goal at_least(double limit, const std::string& what, double measured);

struct Row {
  std::string name;
  std::string unit;
  Spread value;
  int trials = 0;
  std::vector<Ratio> ratios;
  std::string note;
  std::vector<Goal> goals = {};
};

// What a person must know to believe the figures.
struct Machine {
  std::string cpu;
  int cores = 0;
  std::string compiler;
  std::string flags;   // as make built it; empty if not told
  std::string commit;  // the same
};
Machine this_machine(const std::string& flags, const std::string& commit);

class Results {
 public:
  explicit Results(const Machine& machine);

  // how: what is measured, and how, in a sentence or two. Prints the heading.
  void group(const std::string& name, const std::string& how);
  void add(const Row& row);  // prints it

  // All goals of the run once more, each with what was measured.
  void tell_goals() const;

  // False: the file cannot be written.
  bool write_json(const std::string& path) const;

 private:
  struct Group {
    std::string name, how;
    std::vector<Row> rows;
  };
  Machine machine_;
  std::vector<Group> groups_;
};

// Wilson's 95 % interval of a share, in percent (E. B. Wilson, 1927).
Spread wilson_percent(int successes, int trials);

}  // namespace gannet::bench

// One description per parameter: name, default, unit, range, sentence.
//
// A room writes a plain struct whose member initialisers are the defaults, and one function
//
//   void describe(Visitor& v, SearchConfig& c) {
//     v.field("population", c.population, {.min = 4, .max = 4096, .help = "Individuals kept."});
//     v.field("optimiser", c.optimiser, {.choices = {"rm_ga", "gannet"}, .help = "Search
//     method."}); v.group("rm_ga", c.rm_ga, "The genetic algorithm as published.");
//     v.list("thruster", c.thrusters, "One table for each thruster.");
//   }
//
// Visitors make of it the TOML loader, the commented default file, the man page and the reference.
// A name carries its unit where it has one (depth_m, period_ms). Start-up only.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace gannet {

struct About {
  double min = -std::numeric_limits<double>::infinity();  // inclusive, for numbers and elements
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  // non-empty: the only values of a string
  int size = -1;                          // >= 0: the exact length of an array
  std::string_view unit = "";             // m, rad, ms, Hz …
  std::string_view help = "";             // a sentence
};

class Visitor {
 public:
  virtual ~Visitor() = default;

  virtual void field(std::string_view name, bool& value, const About& about) = 0;
  virtual void field(std::string_view name, int& value, const About& about) = 0;
  virtual void field(std::string_view name, double& value, const About& about) = 0;
  virtual void field(std::string_view name, std::string& value, const About& about) = 0;
  virtual void field(std::string_view name, std::vector<double>& value, const About& about) = 0;
  virtual void field(std::string_view name, std::vector<int>& value, const About& about) = 0;
  virtual void field(std::string_view name, std::vector<std::string>& value,
                     const About& about) = 0;

  template <class Config>
  void group(std::string_view name, Config& config, std::string_view help) {
    if (!enter_group(name, help)) return;
    describe(*this, config);
    leave_group();
  }

  // An array of tables ([[thruster]] in TOML). A loader replaces the whole array if the file has
  // one; a printer shows the elements that are there.
  template <class Config>
  void list(std::string_view name, std::vector<Config>& configs, std::string_view help) {
    const int wanted = enter_list(name, static_cast<int>(configs.size()), help);
    // New elements begin from their defaults, never from what an earlier file had at this index.
    if (wanted >= 0) configs.assign(static_cast<std::size_t>(wanted), Config{});
    for (std::size_t i = 0; i < configs.size(); ++i) {
      if (!enter_element(static_cast<int>(i))) continue;
      describe(*this, configs[i]);
      leave_element();
    }
    leave_list();
  }

 protected:
  virtual bool enter_group(std::string_view name, std::string_view help) = 0;
  virtual void leave_group() = 0;
  // Returns the number of elements that the array shall have, or -1 for as it is.
  virtual int enter_list(std::string_view name, int size, std::string_view help) = 0;
  virtual bool enter_element(int index) = 0;
  virtual void leave_element() = 0;
  virtual void leave_list() = 0;
};

}  // namespace gannet

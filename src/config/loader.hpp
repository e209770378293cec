// Loader: the visitor that fills a described struct from a TOML tree. Refuses unknown keys, wrong
// types, numbers that are not finite or out of range, and arrays of the wrong length, all at once;
// a value that is refused leaves its field as it was. Start-up only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/config/problems.hpp"
#include "src/config/toml_reader.hpp"

namespace gannet::config {

// Where each value that was read stands, by its path: "search.population", "camera" (the table),
// "thruster[2].x_m". What is absent is built-in.
using Origins = std::map<std::string, Origin>;

class Loader final : public Visitor {
 public:
  // source names the tree in origins and problems. Everything is borrowed for the visit.
  Loader(const TomlValue& root, const std::string& source, Origins& origins, Problems& problems);

  void field(std::string_view name, bool& value, const About& about) override;
  void field(std::string_view name, int& value, const About& about) override;
  void field(std::string_view name, double& value, const About& about) override;
  void field(std::string_view name, std::string& value, const About& about) override;
  void field(std::string_view name, std::vector<double>& value, const About& about) override;
  void field(std::string_view name, std::vector<int>& value, const About& about) override;
  void field(std::string_view name, std::vector<std::string>& value, const About& about) override;

  void finish();  // after the visit: reports what nobody asked for at the top

 protected:
  bool enter_group(std::string_view name, std::string_view help) override;
  void leave_group() override;
  int enter_list(std::string_view name, int size, std::string_view help) override;
  bool enter_element(int index) override;
  void leave_element() override;
  void leave_list() override;

 private:
  // A table that is being read, or a list (table is then the array).
  struct Level {
    const TomlValue* table;
    std::string path;                // with a final dot, "" at the top
    std::vector<std::string> known;  // names that were asked for
  };
  const TomlValue* take(std::string_view name);
  void refuse(const TomlValue& value, std::string_view name, const std::string& text);
  bool check_kind(const TomlValue& value, std::string_view name, TomlValue::Kind wanted);
  bool check_number(const TomlValue& value, std::string_view name, const About& about);
  bool read(const TomlValue& value, std::string_view name, int& to, const About& about);
  bool read(const TomlValue& value, std::string_view name, double& to, const About& about);
  bool read(const TomlValue& value, std::string_view name, std::string& to, const About& about);
  template <class T>
  void read_array(std::string_view name, std::vector<T>& to, const About& about);
  void refuse_unknown();
  std::string path_of(std::string_view name) const;

  std::vector<Level> levels_;
  const std::string source_;
  Origins& origins_;
  Problems& problems_;
};

// Fills config from the tree and notes where each value came from. format = 1 may stand in every
// file and nothing else may.
template <class Config>
void load(const TomlValue& root, const std::string& source, Config& config, Origins& origins,
          Problems& problems) {
  Loader loader(root, source, origins, problems);
  describe(loader, config);
  loader.finish();
}

}  // namespace gannet::config

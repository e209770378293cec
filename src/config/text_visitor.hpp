// TextVisitor: the visitor that turns every field into text with its path, for those who write:
// the default file, the reference, `config show`. Start-up only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"
#include "src/config/value_text.hpp"

namespace gannet::config {

class TextVisitor : public Visitor {
 public:
  void field(std::string_view name, bool& v, const About& a) override { pass(name, v, "bool", a); }
  void field(std::string_view name, int& v, const About& a) override { pass(name, v, "int", a); }
  void field(std::string_view name, double& v, const About& a) override {
    pass(name, v, "float", a);
  }
  void field(std::string_view name, std::string& v, const About& a) override {
    pass(name, v, "string", a);
  }
  void field(std::string_view name, std::vector<double>& v, const About& a) override {
    pass(name, v, "array of float", a);
  }
  void field(std::string_view name, std::vector<int>& v, const About& a) override {
    pass(name, v, "array of int", a);
  }
  void field(std::string_view name, std::vector<std::string>& v, const About& a) override {
    pass(name, v, "array of string", a);
  }

 protected:
  // path: "search.rm_ga.", "vehicle.thruster[0].", "" at the top.
  const std::string& path() const { return paths_.back(); }

  virtual void on_field(std::string_view name, const std::string& value, std::string_view type,
                        const About& about) = 0;
  virtual void on_group(std::string_view, std::string_view) {}  // before its fields
  virtual void on_group_end() {}
  // What enter_list answers: -1, or a number of elements to show.
  virtual int on_list(std::string_view, int, std::string_view) { return -1; }
  virtual void on_element() {}
  virtual void on_element_end() {}

  bool enter_group(std::string_view name, std::string_view help) override {
    paths_.push_back(path() + std::string(name) + ".");
    on_group(name, help);
    return true;
  }
  void leave_group() override {
    on_group_end();
    paths_.pop_back();
  }
  int enter_list(std::string_view name, int size, std::string_view help) override {
    const int wanted = on_list(name, size, help);
    paths_.push_back(path() + std::string(name));
    return wanted;
  }
  bool enter_element(int index) override {
    paths_.push_back(path() + "[" + std::to_string(index) + "].");
    on_element();
    return true;
  }
  void leave_element() override {
    on_element_end();
    paths_.pop_back();
  }
  void leave_list() override { paths_.pop_back(); }

 private:
  template <class T>
  void pass(std::string_view name, const T& value, std::string_view type, const About& about) {
    on_field(name, value_text(value), type, about);
  }
  std::vector<std::string> paths_ = {""};
};

}  // namespace gannet::config

#include "src/search/search_config.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace gannet::search {
namespace {

// Checks each described field against its own range.
class Checker final : public Visitor {
 public:
  void field(std::string_view n, bool&, const About& a) override { seen(n, a); }
  void field(std::string_view n, int& v, const About& a) override { number(n, v, a); }
  void field(std::string_view n, double& v, const About& a) override { number(n, v, a); }
  void field(std::string_view n, std::string& v, const About& a) override {
    seen(n, a);
    EXPECT_NE(std::find(a.choices.begin(), a.choices.end(), v), a.choices.end()) << n << " " << v;
  }
  void field(std::string_view n, std::vector<double>&, const About& a) override { seen(n, a); }
  void field(std::string_view n, std::vector<int>& v, const About& a) override {
    EXPECT_EQ(static_cast<int>(v.size()), a.size) << n;
    seen(n, a);
  }
  void field(std::string_view n, std::vector<std::string>&, const About& a) override { seen(n, a); }
  std::set<std::string> names;

 private:
  bool enter_group(std::string_view n, std::string_view) override {
    group_ = n;
    return true;
  }
  void leave_group() override { group_.clear(); }
  int enter_list(std::string_view, int, std::string_view) override { return -1; }
  bool enter_element(int) override { return true; }
  void leave_element() override {}
  void leave_list() override {}
  void number(std::string_view n, double v, const About& a) {
    seen(n, a);
    EXPECT_GE(v, a.min) << n;
    EXPECT_LE(v, a.max) << n;
  }
  void seen(std::string_view n, const About& a) {
    EXPECT_TRUE(names.insert(group_ + "." + std::string(n)).second) << n << " is there twice";
    EXPECT_FALSE(a.help.empty()) << n;
  }
  std::string group_;
};

TEST(SearchConfig, every_default_lies_in_its_own_range_and_every_field_is_explained) {
  SearchConfig config;
  Checker checker;
  describe(checker, config);
  for (const char* name :
       {"rm_ga.mutation_rate", "differential_evolution.reseed_share", "cma_es.restart_growth"}) {
    EXPECT_EQ(checker.names.count(name), 1u) << name;
  }
}

}  // namespace
}  // namespace gannet::search

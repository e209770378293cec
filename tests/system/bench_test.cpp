// The benchmark runs from end to end and writes what it promises. Its figures are not judged: how
// fast a machine is at this moment is no test.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/temporary_folder.hpp"

namespace gannet {
namespace {

using Json = nlohmann::json;

std::string binary() {
  const char* build = std::getenv("GANNET_BUILD");
  return std::string(build != nullptr ? build : "build/release") + "/tests/bench/run";
}

bool is_time(const Json& spread) {
  const double low = spread.at("low"), median = spread.at("median"), high = spread.at("high");
  return std::isfinite(low) && std::isfinite(median) && std::isfinite(high) && low <= median &&
         median <= high;
}

TEST(Bench, a_quick_run_writes_all_groups_with_references_and_trials) {
  if (!std::ifstream(binary()).good()) GTEST_SKIP() << binary() << " is not built";
  const test::TemporaryFolder folder;
  const std::string file = folder / "results.json";
  ASSERT_EQ(std::system((binary() + " --quick --json " + file + " > /dev/null").c_str()), 0);
  std::ifstream in(file);
  const Json all = Json::parse(in, nullptr, false);
  ASSERT_FALSE(all.is_discarded());
  EXPECT_EQ(all.at("format"), 1);
  EXPECT_FALSE(all.at("machine").at("cpu").get<std::string>().empty());
  std::map<std::string, Json> rows;
  for (const Json& group : all.at("groups")) {
    EXPECT_FALSE(group.at("how").get<std::string>().empty());
    for (const Json& row : group.at("rows")) rows[row.at("name")] = row;
  }
  for (const char* kernel : {"project", "project_lens", "correlate", "vote", "compare", "p001",
                             "p002", "p000", "gannet"}) {
    ASSERT_TRUE(rows.count(std::string(kernel) + ", scalar")) << kernel;
    EXPECT_GE(rows[std::string(kernel) + ", scalar"].at("ratios").size(), 2u) << kernel;
  }
  EXPECT_TRUE(rows.count("LeasePool lend + return"));
  ASSERT_TRUE(rows.count("frame to pose, locked"));
  const Json& goals = rows["frame to pose, locked"].at("goals");
  ASSERT_EQ(goals.size(), 2u);
  for (const Json& goal : goals) {
    const double limit = goal.at("is") == "at most 2 ms, p99" ? 2.0 : 1.3;
    EXPECT_EQ(goal.at("reached").get<bool>(), goal.at("measured").get<double>() <= limit) << goal;
  }
  for (const auto& [name, row] : rows) {
    if (row.at("trials") == 0) continue;  // skipped, and says so
    EXPECT_TRUE(is_time(row.at("value"))) << name;
    EXPECT_GT(row.at("value").at("median"), 0) << name;
    for (const Json& ratio : row.at("ratios")) EXPECT_TRUE(is_time(ratio.at("value"))) << name;
  }
}

TEST(Bench, refuses_a_group_that_it_does_not_know) {
  if (!std::ifstream(binary()).good()) GTEST_SKIP() << binary() << " is not built";
  const int status = std::system((binary() + " --only nothing > /dev/null 2>&1").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

}  // namespace
}  // namespace gannet

#include "src/world/run_record.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace gannet::world {
namespace {

RunResult example() {
  RunResult result;
  result.trace.motors = 2;
  for (int i = 0; i < 3; ++i) {
    TraceRow row;
    row.time_s = 0.005 * i;
    row.throttle = {0.25, -0.5};
    result.trace.rows.push_back(row);
  }
  result.trace.marks = {{0.005, "arm"}};
  result.trace.turns = {{0, true}, {0.0075, false}};
  result.verdicts = {{"settle_s < 6", "4.2", true}, {"rms_mm < 1", "3", false}};
  result.top = control::Json::parse(
      R"({"latencies": {"frame_to_can": {"count": 3, "p50_us": 1500, "max_us": 2000}},
          "drops": {"frames": 9, "vision_skipped": 2, "can_malformed": 0}})");
  return result;
}

std::string file_text(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(RunRecord, says_every_verdict) {
  const std::string text = result_table(example());
  EXPECT_NE(text.find("settle_s < 6    4.2  passed"), std::string::npos) << text;
  EXPECT_NE(text.find("FAILED"), std::string::npos);
  EXPECT_FALSE(example().passed());
}

TEST(RunRecord, says_times_and_what_was_lost) {
  const std::string text = timing_table(example());
  EXPECT_NE(text.find("frame_to_can"), std::string::npos);
  EXPECT_NE(text.find("1.500"), std::string::npos) << text;
  EXPECT_NE(text.find("2 vision_skipped"), std::string::npos);
  EXPECT_EQ(text.find("can_malformed"), std::string::npos);
}

TEST(RunRecord, files_can_be_read_by_programs) {
  const std::string folder = ::testing::TempDir() + "gannet-run-record-test";
  Scenario scenario;
  scenario.name = "example";
  ASSERT_TRUE(write_record(folder, scenario, example(), true));
  const auto json = control::Json::parse(file_text(folder + "/result.json"));
  EXPECT_EQ(json["scenario"], "example");
  EXPECT_EQ(json["passed"], false);
  EXPECT_EQ(json["checks"][0]["found"], "4.2");
  EXPECT_EQ(json["measures"]["throttle"], 0.5);
  EXPECT_TRUE(json["measures"]["fitness"].is_null());
  EXPECT_EQ(json["reactions"][0]["event"], "arm");
  EXPECT_NEAR(json["reactions"][0]["turning_ms"].get<double>(), 2.5, 1e-9);
  EXPECT_TRUE(json["reactions"][0]["still_ms"].is_null());
  std::stringstream csv(file_text(folder + "/trace.csv"));
  std::string header, row;
  std::getline(csv, header);
  int rows = 0;
  for (; std::getline(csv, row); ++rows)
    EXPECT_EQ(std::count(row.begin(), row.end(), ','),
              std::count(header.begin(), header.end(), ','));
  EXPECT_EQ(rows, 3);
  EXPECT_EQ(file_text(folder + "/events.csv"), "time_s,event\n0.005000,arm\n");
  std::filesystem::remove_all(folder);
}

TEST(RunRecord, says_where_it_cannot_write) {
  const auto written = write_record("/proc/no/such", {}, example(), true);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().text.find("/proc/no/such"), std::string::npos);
}

}  // namespace
}  // namespace gannet::world

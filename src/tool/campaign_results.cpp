#include "src/tool/campaign_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "platform/linux/whole_file.hpp"
#include "src/report/statistics.hpp"
#include "src/report/table.hpp"

namespace gannet::tool {
namespace {

using control::Json;

constexpr std::size_t kMostBytes = std::size_t{1} << 28;
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

double number_or(const Json& json, double otherwise) {
  return json.is_number() ? json.get<double>() : otherwise;
}
Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

CampaignBounds bounds_from(const Json& json) {
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  return {number_or(json.at(0), -kOpen), number_or(json.at(1), kOpen)};
}
Json bounds_json(const CampaignBounds& bounds) {
  return {number_or_null(bounds.least), number_or_null(bounds.most)};
}

std::vector<double> numbers_from(const Json& json) {
  std::vector<double> numbers;
  for (const Json& value : json) numbers.push_back(number_or(value, kNothing));
  return numbers;
}
Json numbers_json(const std::vector<double>& numbers) {
  Json json = Json::array();
  for (const double value : numbers) json.push_back(number_or_null(value));
  return json;
}

// Errors of the reader, which throws, become values; a file of another kind is one.
template <class Read>
Result<void> read_json(const std::string& path, Read read) {
  const auto bytes = linux_os::read_file(path, kMostBytes);
  if (!bytes) return bytes.error();
  try {
    const Json json = Json::parse(bytes->begin(), bytes->end());
    if (json.at("format") != 1) return Error{path + ": format is not 1"};
    read(json);
  } catch (const Json::exception& error) {
    return Error{path + ": not such a file: " + error.what()};
  }
  return {};
}

struct SeedRun {
  int seed;
  Json json;
};
using RunKey = std::pair<std::string, std::string>;  // experiment, method

CampaignRow row_of(const std::vector<SeedRun>& runs, std::size_t figure) {
  const Json& first = runs.front().json;
  const Json& head = first.at("figures").at(figure);
  CampaignRow row{.paper = first.at("paper"),
                  .experiment = first.at("experiment"),
                  .what = first.at("what"),
                  .method = first.at("method"),
                  .figure = head.at("name"),
                  .unit = head.at("unit"),
                  .theirs = head.at("theirs"),
                  .allowed = bounds_from(head.at("allowed")),
                  .goal = bounds_from(head.at("goal"))};
  for (const SeedRun& run : runs) {
    row.seeds.push_back(run.seed);
    row.values.push_back(number_or(run.json.at("figures").at(figure).at("value"), kNothing));
    row.trials += run.json.at("trials").get<long>();
    row.host_s += run.json.at("host_s").get<double>();
  }
  return row;
}

CampaignCurve curve_of(const std::vector<SeedRun>& runs, std::size_t curve) {
  const Json& first = runs.front().json;
  const Json& head = first.at("curves").at(curve);
  CampaignCurve out{.experiment = first.at("experiment"),
                    .what = first.at("what"),
                    .method = first.at("method"),
                    .plot = head.at("plot"),
                    .name = head.at("name"),
                    .x_unit = head.at("x_unit"),
                    .y_unit = head.at("y_unit"),
                    .x = numbers_from(head.at("x"))};
  out.y.assign(out.x.size(), 0);
  for (const SeedRun& run : runs)
    for (std::size_t i = 0; i < out.y.size(); ++i)
      out.y[i] += number_or(run.json.at("curves").at(curve).at("y").at(i), kNothing) /
                  static_cast<double>(runs.size());
  return out;
}

Json row_json(const CampaignRow& row) {
  const std::vector<double> known = row.known();
  const report::Summary s = report::summarise(known);
  const report::MeanInterval interval = report::mean95(known);
  return {{"paper", row.paper},
          {"experiment", row.experiment},
          {"what", row.what},
          {"method", row.method},
          {"figure", row.figure},
          {"unit", row.unit},
          {"theirs", row.theirs},
          {"mean", number_or_null(s.mean)},
          {"deviation", number_or_null(s.deviation)},
          {"least", number_or_null(s.min)},
          {"largest", number_or_null(s.max)},
          {"interval95", {number_or_null(interval.low), number_or_null(interval.high)}},
          {"trials", row.trials},
          {"seeds", row.seeds},
          {"values", numbers_json(row.values)},
          {"allowed", bounds_json(row.allowed)},
          {"allowed_in", row.inside(row.allowed)},
          {"allowed_passed", row.allowed.any() ? Json(row.passed(row.allowed)) : Json()},
          {"goal", bounds_json(row.goal)},
          {"goal_in", row.inside(row.goal)},
          {"goal_passed", row.goal.any() ? Json(row.passed(row.goal)) : Json()},
          {"host_s", row.host_s}};
}

}  // namespace

bool CampaignBounds::any() const { return std::isfinite(least) || std::isfinite(most); }

std::string CampaignBounds::text() const {
  const auto plain = [](double value) {
    return report::number(value, value == std::round(value) ? 0 : 2);
  };
  if (!any()) return "";
  if (!std::isfinite(least)) return "≤ " + plain(most);
  if (!std::isfinite(most)) return "≥ " + plain(least);
  return plain(least) + " … " + plain(most);
}

std::vector<double> CampaignRow::known() const {
  std::vector<double> out;
  for (const double value : values)
    if (std::isfinite(value)) out.push_back(value);
  return out;
}

int CampaignRow::inside(const CampaignBounds& bounds) const {
  return static_cast<int>(std::count_if(values.begin(), values.end(),
                                        [&](double value) { return bounds.hold(value); }));
}

bool CampaignRow::passed(const CampaignBounds& bounds) const {
  return !bounds.any() || 100 * inside(bounds) >= 99 * static_cast<int>(values.size());
}

bool Campaign::passed() const {
  return std::all_of(rows.begin(), rows.end(), [](const CampaignRow& row) {
    return row.method != "ours" || row.passed(row.allowed);
  });
}

Result<Campaign> merge_results(const std::vector<std::string>& paths, const std::string& commit) {
  Campaign campaign{.commit = commit};
  std::vector<RunKey> order;
  std::map<RunKey, std::vector<SeedRun>> groups;
  for (const std::string& path : paths) {
    bool twice = false;
    const auto read = read_json(path, [&](const Json& json) {
      const RunKey key = {json.at("experiment"), json.at("method")};
      const int seed = json.at("seed");
      if (groups.count(key) == 0) order.push_back(key);
      std::vector<SeedRun>& runs = groups[key];
      for (const SeedRun& run : runs) twice |= run.seed == seed;
      campaign.version = json.at("version");
      campaign.host_s += json.at("host_s").get<double>();
      runs.push_back({seed, json});
    });
    if (!read) return read.error();
    if (twice) return Error{path + ": this experiment, method and seed is there already"};
    ++campaign.runs;
  }
  std::sort(order.begin(), order.end());
  try {
    for (const RunKey& key : order) {
      std::vector<SeedRun>& runs = groups[key];
      std::sort(runs.begin(), runs.end(),
                [](const SeedRun& a, const SeedRun& b) { return a.seed < b.seed; });
      const Json& first = runs.front().json;
      for (std::size_t i = 0; i < first.at("figures").size(); ++i)
        campaign.rows.push_back(row_of(runs, i));
      for (std::size_t i = 0; i < first.at("curves").size(); ++i)
        campaign.curves.push_back(curve_of(runs, i));
    }
  } catch (const Json::exception& error) {
    return Error{std::string("the files do not fit each other: ") + error.what()};
  }
  return campaign;
}

Json campaign_json(const Campaign& campaign) {
  Json json;
  json["format"] = 1;
  json["version"] = campaign.version;
  json["commit"] = campaign.commit;
  json["runs"] = campaign.runs;
  json["host_s"] = campaign.host_s;
  json["rows"] = Json::array();
  for (const CampaignRow& row : campaign.rows) json["rows"].push_back(row_json(row));
  json["curves"] = Json::array();
  for (const CampaignCurve& c : campaign.curves)
    json["curves"].push_back({{"experiment", c.experiment},
                              {"what", c.what},
                              {"method", c.method},
                              {"plot", c.plot},
                              {"name", c.name},
                              {"x_unit", c.x_unit},
                              {"y_unit", c.y_unit},
                              {"x", numbers_json(c.x)},
                              {"y", numbers_json(c.y)}});
  return json;
}

Result<Campaign> read_campaign(const std::string& path) {
  Campaign campaign;
  const auto read = read_json(path, [&](const Json& json) {
    campaign.version = json.at("version");
    campaign.commit = json.at("commit");
    campaign.runs = json.at("runs");
    campaign.host_s = json.at("host_s");
    for (const Json& r : json.at("rows"))
      campaign.rows.push_back({r.at("paper"), r.at("experiment"), r.at("what"), r.at("method"),
                               r.at("figure"), r.at("unit"), r.at("theirs"),
                               bounds_from(r.at("allowed")), bounds_from(r.at("goal")),
                               r.at("seeds").get<std::vector<int>>(), numbers_from(r.at("values")),
                               r.at("trials"), r.at("host_s")});
    for (const Json& c : json.at("curves"))
      campaign.curves.push_back({c.at("experiment"), c.at("what"), c.at("method"), c.at("plot"),
                                 c.at("name"), c.at("x_unit"), c.at("y_unit"),
                                 numbers_from(c.at("x")), numbers_from(c.at("y"))});
  });
  if (!read) return read.error();
  return campaign;
}

}  // namespace gannet::tool

// CampaignResults: result files of `gannet-world paper`, joined: for each experiment, method and
// figure the values of all seeds with mean, spread and 95 % interval, beside what the paper says,
// allows, and what the goal is. Normal thread.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "platform/base/result.hpp"
#include "src/control/json.hpp"

namespace gannet::tool {

struct CampaignBounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  bool any() const;
  bool hold(double value) const { return value >= least && value <= most; }  // NaN: no
  std::string text() const;                                                  // "≤ 3"; "": open
};

struct CampaignRow {
  std::string paper, experiment, what, method, figure, unit, theirs;
  CampaignBounds allowed, goal;
  std::vector<int> seeds = {};      // rising
  std::vector<double> values = {};  // of each seed; NaN: the run could not say
  long trials = 0;                  // frames of all seeds
  double host_s = 0;  // of all seeds' runs, which make the experiment's other figures too

  std::vector<double> known() const;  // the values that are numbers
  int inside(const CampaignBounds& bounds) const;
  // In at least 99 of 100 seeds; open bounds: true.
  bool passed(const CampaignBounds& bounds) const;
};

struct CampaignCurve {
  std::string experiment, what, method, plot, name, x_unit, y_unit;
  std::vector<double> x = {}, y = {};  // y: mean over the seeds
};

struct Campaign {
  std::string commit = {}, version = {};
  int runs = 0;
  double host_s = 0;
  std::vector<CampaignRow> rows = {};  // in the order of the files
  std::vector<CampaignCurve> curves = {};

  bool passed() const;  // our method inside all that the papers allow
};

// Error: a file that is none, or two of the same experiment, method and seed.
Result<Campaign> merge_results(const std::vector<std::string>& paths, const std::string& commit);

control::Json campaign_json(const Campaign& campaign);
Result<Campaign> read_campaign(const std::string& path);  // of campaign_json

}  // namespace gannet::tool

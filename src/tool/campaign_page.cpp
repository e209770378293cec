#include "src/tool/campaign_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/report/progress.hpp"
#include "src/report/statistics.hpp"
#include "src/report/svg_plot.hpp"

namespace gannet::tool {
namespace {

using report::number;

int decimals_for(double value) {
  const double size = std::abs(value);
  return !(size < 100) ? 1 : size >= 10 ? 2 : 3;
}

// "pass", or "fail" with how many of the seeds are inside.
std::string verdict(const CampaignRow& row, const CampaignBounds& bounds) {
  if (!bounds.any()) return "";
  return row.passed(bounds) ? "pass" : "fail";
}

std::string inside_text(const CampaignRow& row) {
  const CampaignBounds& bounds = row.allowed.any() ? row.allowed : row.goal;
  if (!bounds.any()) return "";
  const int count = static_cast<int>(row.values.size());
  const report::Interval share = report::wilson95(row.inside(bounds), count);
  return std::to_string(row.inside(bounds)) + " of " + std::to_string(count) + ", " +
         number(100 * share.low, 0) + "–" + number(100 * share.high, 0) + " %";
}

std::vector<std::string> cells(const CampaignRow& row) {
  const std::vector<double> known = row.known();
  const double mean = report::mean(known);
  const report::MeanInterval interval = report::mean95(known);
  const int decimals = decimals_for(mean);
  const bool has_interval = std::isfinite(interval.low);
  return {
      row.paper,
      row.experiment,
      row.method,
      row.figure + (row.unit.empty() ? "" : ", " + row.unit),
      row.theirs,
      number(mean, decimals),
      number(report::standard_deviation(known), decimals),
      has_interval ? number(interval.low, decimals) + " … " + number(interval.high, decimals) : "",
      row.allowed.text(),
      verdict(row, row.allowed),
      row.goal.text(),
      verdict(row, row.goal),
      inside_text(row),
      std::to_string(row.trials),
      number(row.host_s, 0)};
}

// Curves of one experiment and method, a plot for each kind.
void add_curves(report::HtmlReport& page, const Campaign& campaign) {
  for (std::size_t i = 0; i < campaign.curves.size();) {
    const CampaignCurve& head = campaign.curves[i];
    page.subheading(head.experiment + ", " + head.method + ": " + head.what);
    page.begin_row();
    const auto is_of = [&](const CampaignCurve& c) {
      return c.experiment == head.experiment && c.method == head.method;
    };
    std::vector<std::string> plots;
    std::size_t end = i;
    for (; end < campaign.curves.size() && is_of(campaign.curves[end]); ++end)
      if (std::find(plots.begin(), plots.end(), campaign.curves[end].plot) == plots.end())
        plots.push_back(campaign.curves[end].plot);
    for (const std::string& plot : plots) {
      report::PlotFrame frame{.title = plot, .x = {"frequency", head.x_unit}, .y = {plot}};
      std::vector<report::Series> series;
      for (std::size_t k = i; k < end; ++k) {
        const CampaignCurve& curve = campaign.curves[k];
        if (curve.plot != plot) continue;
        frame.y.unit = curve.y_unit;
        series.push_back({curve.name, curve.x, curve.y});
      }
      page.svg(report::line_plot(frame, series), "Mean of the seeds.");
    }
    page.end_row();
    i = end;
  }
}

}  // namespace

report::Table campaign_table(const Campaign& campaign) {
  report::Table table({"paper", "experiment", "method", "figure", "theirs", "ours", "± seeds",
                       "95 % of the mean", "allowed", "inside", "goal", "reached", "seeds",
                       "frames", "s"});
  for (const CampaignRow& row : campaign.rows) table.add(cells(row));
  return table;
}

report::HtmlReport campaign_page(const Campaign& campaign) {
  report::HtmlReport page("Gannet: the papers' experiments",
                          "gannet " + campaign.version +
                              (campaign.commit.empty() ? "" : " · " + campaign.commit) + " · " +
                              (campaign.passed() ? "passed" : "FAILED"));
  page.paragraph(
      std::to_string(campaign.runs) + " runs, " +
      report::duration_text(from_seconds(campaign.host_s)) +
      " of work, each with one experiment, one method and one seed, in simulation and stepped "
      "time. Ours: the mean of the seeds' figures, their standard deviation, and the 95 % interval "
      "of the mean (Student). Inside and reached: in at least 99 of 100 seeds; the column after "
      "them counts the seeds inside what is allowed, or else inside the goal, with Wilson's 95 % "
      "interval. Method papers: rm_ga with the paper's fitness and 540 evaluations a frame, "
      "without refinement, prediction and feed-forward.");
  page.table(campaign_table(campaign), "Every figure of every experiment.");
  if (!campaign.curves.empty()) {
    page.heading("Frequency response");
    add_curves(page, campaign);
  }
  return page;
}

}  // namespace gannet::tool

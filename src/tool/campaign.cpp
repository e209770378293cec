#include <cstdio>

#include "platform/linux/whole_file.hpp"
#include "src/tool/campaign_page.hpp"
#include "src/tool/campaign_results.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"

namespace gannet::tool {
namespace {

const char* const kMerge = "gannet campaign merge";
const char* const kReport = "gannet campaign report";

Command describe_merge() {
  return {.name = kMerge,
          .summary = "joins result files of the papers' experiments",
          .description =
              "Reads what gannet-world paper -o wrote, on one machine or many, and writes one "
              "file: for each experiment, method and figure the values of all seeds, mean, "
              "standard deviation and 95 % interval, beside the paper's.",
          .options = {{.name = "output",
                       .letter = 'o',
                       .value = "FILE",
                       .preset = "results.json",
                       .help = "The joined results."},
                      {.name = "commit", .value = "TEXT", .help = "Of the source, to be kept."}},
          .positionals = {{.name = "result",
                           .value = "FILE",
                           .required = true,
                           .repeats = true,
                           .help = "A result; each experiment, method and seed once."}},
          .example = "gannet campaign merge results/*.json -o results.json",
          .exit_codes = "0  written\n2  bad input; nothing is written",
          .see_also = "gannet-campaign-report(1), gannet-world-paper(1)"};
}

Command describe_report() {
  return {.name = kReport,
          .summary = "makes a page of joined results",
          .description =
              "Prints the table of a file that gannet campaign merge wrote, and writes it with "
              "plots as one self-contained HTML page.",
          .options = {{.name = "output",
                       .letter = 'o',
                       .value = "FILE",
                       .preset = "report.html",
                       .help = "The page."}},
          .positionals = {{.name = "results",
                           .value = "FILE",
                           .required = true,
                           .help = "The joined results."}},
          .example = "gannet campaign report results.json -o report.html",
          .exit_codes =
              "0  our method is inside all that the papers allow\n1  it is not\n"
              "2  bad input",
          .see_also = "gannet-campaign-merge(1)"};
}

int refuse(const char* name, const Error& error) {
  tell(name, error.text);
  return 2;
}

int run_merge(const Arguments& arguments) {
  const auto merged = merge_results(arguments.texts("result"), arguments.text("commit"));
  if (!merged) return refuse(kMerge, merged.error());
  const auto written =
      linux_os::write_file(arguments.text("output"), campaign_json(*merged).dump(1) + "\n");
  if (!written) return refuse(kMerge, written.error());
  std::printf("%s: %d runs\n", arguments.text("output").c_str(), merged->runs);
  return 0;
}

int run_report(const Arguments& arguments) {
  const auto campaign = read_campaign(arguments.text("results"));
  if (!campaign) return refuse(kReport, campaign.error());
  const auto written = campaign_page(*campaign).write(arguments.text("output"));
  if (!written) return refuse(kReport, written.error());
  std::printf("%s%s: %s\n", campaign_table(*campaign).text().c_str(),
              arguments.text("output").c_str(), campaign->passed() ? "passed" : "FAILED");
  return campaign->passed() ? 0 : 1;
}

}  // namespace

Subcommand campaign_merge_subcommand() { return {describe_merge(), &run_merge}; }
Subcommand campaign_report_subcommand() { return {describe_report(), &run_report}; }

}  // namespace gannet::tool

#include <cstdio>

#include "platform/linux/whole_file.hpp"
#include "src/tool/inputs.hpp"
#include "src/tool/offline.hpp"
#include "src/tool/report_figures.hpp"
#include "src/tool/report_page.hpp"
#include "src/tool/report_pictures.hpp"

namespace gannet::tool {
namespace {

const char* const kName = "gannet report";

Command describe_report() {
  return {
      .name = kName,
      .summary = "makes a page with figures, plots and pictures of recorded runs",
      .description =
          "Reads what gannet-world --record wrote (with --keep-every also frames for pictures), "
          "prints a table of figures and writes one self-contained HTML page.\n\n"
          "With --stereo also answers of gannet locate --roi on a real pair are set beside the "
          "depth that the pair's known disparity says. The folder holds rig.toml, left.png, "
          "right.png (rectified), disparity.npy (32-bit floats, pixels), rectangles.csv "
          "(name,x,y,width,height) and NAME.json for each rectangle.",
      .options = {{.name = "output",
                   .letter = 'o',
                   .value = "FILE",
                   .preset = "report.html",
                   .help = "The page."},
                  {.name = "stereo", .value = "DIR", .help = "Answers on a pair of known depth."},
                  {.name = "picture",
                   .value = "FILE",
                   .help = "Also write the first and the last overlay of the first run's left "
                           "camera as one JPEG."}},
      .positionals = {{.name = "run",
                       .value = "RUN_DIR",
                       .required = true,
                       .repeats = true,
                       .help = "A recorded run; the page begins with the first."}},
      .example =
          "gannet-world rov_station_keeping --record out --keep-every 15\n"
          "gannet report out -o report.html",
      .exit_codes =
          "0  passed\n1  a check of a stepped run or a depth failed; the page is there\n"
          "2  bad input",
      .see_also = "gannet-world(1), gannet-locate(1)"};
}

int refuse(const Error& error) {
  tell(kName, error.text);
  return 2;
}

Result<ReportContent> read_content(const Arguments& arguments) {
  ReportContent content;
  for (const std::string& folder : arguments.texts("run")) {
    auto run = read_run(folder);
    if (!run) return run.error();
    content.runs.push_back(std::move(*run));
  }
  if (arguments.given("stereo")) {
    auto stereo = read_stereo(arguments.text("stereo"));
    if (!stereo) return stereo.error();
    content.stereo = std::move(*stereo);
  }
  return content;
}

// As good as goes into what a README should weigh.
Result<std::vector<std::uint8_t>> small_jpeg(const hal::Image& image) {
  constexpr std::size_t kMostBytes = 120'000;
  for (int quality = 90; quality > 30; quality -= 5) {
    auto jpeg = jpeg_of(image, quality);
    if (!jpeg || jpeg->size() <= kMostBytes) return jpeg;
  }
  return jpeg_of(image, 30);
}

Result<void> write_picture(const ReportRun& run, const std::string& path) {
  const auto pictures = run_pictures(run, 2);
  if (!pictures) return pictures.error();
  if (pictures->size() < 2)
    return Error{"--picture: " + run.folder +
                 " holds less than two frames with the target found; record with --keep-every"};
  const auto jpeg = small_jpeg(before_and_after(pictures->front(), pictures->back()));
  if (!jpeg) return jpeg.error();
  return linux_os::write_file(path, *jpeg);
}

int run(const Arguments& arguments) {
  const auto content = read_content(arguments);
  if (!content) return refuse(content.error());
  const auto page = report_page(*content);
  if (!page) return refuse(page.error());
  if (auto written = page->write(arguments.text("output")); !written)
    return refuse(written.error());
  if (arguments.given("picture")) {
    const auto written = write_picture(content->runs.front(), arguments.text("picture"));
    if (!written) return refuse(written.error());
  }
  std::printf("%s", figures_table(content->runs).text().c_str());
  if (content->stereo) std::printf("\n%s", content->stereo->table().text().c_str());
  std::printf("\n%s: %s\n", arguments.text("output").c_str(),
              passed(*content) ? "passed" : "FAILED");
  return passed(*content) ? 0 : 1;
}

}  // namespace

Subcommand report_subcommand() { return {describe_report(), &run}; }

}  // namespace gannet::tool

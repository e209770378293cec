#include "src/tool/report_page.hpp"

#include <algorithm>

#include "src/report/table.hpp"
#include "src/tool/report_figures.hpp"
#include "src/tool/report_pictures.hpp"
#include "src/tool/report_plots.hpp"

namespace gannet::tool {
namespace {

using report::HtmlReport;
using report::number;

constexpr int kMostPictures = 6;
constexpr int kJpegQuality = 85;

std::string text_at(const control::Json& json, std::string_view path) {
  const control::Json* text = member_at(json, path);
  return text != nullptr && text->is_string() ? text->get<std::string>() : "";
}

Result<void> add_picture(HtmlReport& page, const hal::Image& image, const std::string& caption) {
  const auto jpeg = jpeg_of(image, kJpegQuality);
  if (!jpeg) return jpeg.error();
  return page.picture(*jpeg, caption);
}

void row_of_plots(HtmlReport& page, const std::vector<std::pair<std::string, std::string>>& plots) {
  page.begin_row();
  for (const auto& [svg, caption] : plots)
    if (!svg.empty()) page.svg(svg, caption);
  page.end_row();
}

Result<void> add_pictures(HtmlReport& page, const ReportRun& run) {
  const auto pictures = run_pictures(run, kMostPictures);
  if (!pictures) return pictures.error();
  if (pictures->empty()) return {};
  page.subheading("What the cameras saw");
  page.paragraph(
      "Left and right image as the daemon got them, with the outline of the model (magenta) and "
      "its axes (x red, y green, z blue) at the pose that it recognised in this pair, before the "
      "filter.");
  for (std::size_t i = 0; i < pictures->size(); ++i) {
    if (i % 2 == 0) page.begin_row();
    const auto added = add_picture(page, (*pictures)[i].image, caption_of((*pictures)[i]));
    if (!added) return added;
    if (i % 2 == 1 || i + 1 == pictures->size()) page.end_row();
  }
  return {};
}

void add_timing(HtmlReport& page, const ReportRun& run) {
  page.subheading("Times");
  page.paragraph(
      run.stepped
          ? "In stepped time the world waits for the daemon, so these tell how long the work "
            "took, not whether it was in time; from exposure to CAN is counted by the "
            "scenario's clock and holds the images' simulated latency."
          : "By the machine's clock, while the simulator drew both cameras' images on the same "
            "machine. From exposure to CAN holds the images' simulated latency.");
  row_of_plots(page, {{latency_plot(run, "frame_to_pose", "Frame taken → pose"), ""},
                      {latency_plot(run, "frame_to_can", "Frame taken → motors told"), ""}});
  row_of_plots(
      page,
      {{latency_plot(run, "exposure_to_can", "Middle of exposure → motors told"), ""},
       {run.stepped ? ""
                    : latency_plot(run, "servo_jitter", "Servo jitter: woken late", "µs", 1000),
        ""}});
  if (!run.stepped)
    page.table(
        stages_table(run),
        "Stages of the daemon's loops. capture/take holds the wait for the next pair; the longest "
        "vision/recognise is the first search, from nothing.");
}

Result<void> add_run(HtmlReport& page, const ReportRun& run) {
  page.heading((run.stepped ? "Stepped run: " : "Live run: ") + run.scenario());
  std::string words = "To " + text_at(run.result, "description") + ". One run of " +
                      number(number_at(run.result, "duration_s"), 1) + " s, seed " +
                      number(number_at(run.result, "seed"), 0) + ", done in " +
                      number(number_at(run.result, "host_s"), 0) + " s. ";
  words += run.stepped ? "The world gave the time step by step: it repeats bit for bit."
                       : "The daemon's threads ran by the machine's clock; its checks are told "
                         "and decide nothing, because they hang on the machine's load.";
  page.paragraph(words);
  if (const auto* notes = member_at(run.result, "notes"); notes != nullptr && notes->is_array())
    for (const control::Json& note : *notes)
      if (note.is_string()) page.paragraph(note.get<std::string>() + ".");
  page.table(checks_table(run), "The scenario's checks.");
  page.subheading("How it came to the goal and held it");
  page.paragraph(
      "Σ_H is the hand: midway between the cameras, x right, y down, z forward. Errors are those "
      "of the simulator's truth, not of what the daemon believed. \"Held\" is from " +
      number(held_from_s(run), 1) + " s on.");
  row_of_plots(page, {{error_plot(run), ""}, {held_error_plot(run), ""}});
  row_of_plots(page, {{path_from_behind(run),
                       "The target's path, and the point before the "
                       "hand that is to coincide with it."},
                      {path_from_above(run), ""}});
  row_of_plots(page, {{yaw_plot(run), ""}, {throttle_plot(run), ""}});
  page.subheading("What was recognised");
  row_of_plots(page, {{estimate_plot(run), ""}, {fitness_plot(run), ""}});
  if (auto added = add_pictures(page, run); !added) return added;
  add_timing(page, run);
  return {};
}

Result<void> add_stereo(HtmlReport& page, const ReportStereo& stereo) {
  page.heading("A real pair with known depth");
  page.paragraph(
      "Rectangles of the left image of a real stereo pair, each found from nothing by gannet "
      "locate --roi: depth and two tilts of the plane that makes both images agree. The truth is "
      "the plane that fits the pair's published disparities in the rectangle best, as depth "
      "f·B / (d + shift of the principal points). A depth passes within " +
      number(100 * kDepthLimit, 0) + " %.");
  page.table(stereo.table(),
             std::to_string(stereo.answers.size()) + " rectangles, one trial each.");
  return add_picture(page, stereo.picture,
                     "The planes found, in both images: in the right one each piece lies where it "
                     "belongs if its depth and tilt are right.");
}

}  // namespace

bool passed(const ReportContent& content) {
  const auto fine = [](const ReportRun& run) { return !run.stepped || run.passed(); };
  return std::all_of(content.runs.begin(), content.runs.end(), fine) &&
         (!content.stereo || content.stereo->passed());
}

Result<HtmlReport> report_page(const ReportContent& content) {
  HtmlReport page(
      "Gannet: " + content.runs.front().scenario(),
      "gannet " GANNET_VERSION " · " + std::string(passed(content) ? "passed" : "FAILED"));
  page.paragraph(
      "The daemon gannetd ran as its own process: it took stereo images from the simulated cameras "
      "through shared memory, recognised the target in each pair, and told the thrusters by "
      "DroneCAN frames where to go. The simulator moved vehicle, water and target, and knew the "
      "truth.");
  page.table(figures_table(content.runs),
             "In one run each. \"Held\" begins where the run has settled. RMS: root mean square.");
  for (const ReportRun& run : content.runs)
    if (auto added = add_run(page, run); !added) return added.error();
  if (content.stereo)
    if (auto added = add_stereo(page, *content.stereo); !added) return added.error();
  page.heading("Counts");
  page.table(counts_table(content.runs), "What the daemon counted: frames, losses, CAN.");
  return page;
}

}  // namespace gannet::tool

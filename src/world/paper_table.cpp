#include "src/world/paper_table.hpp"

#include <cmath>

namespace gannet::world {
namespace {

constexpr Bounds at_most(double most) { return {.most = most}; }
constexpr Bounds at_least(double least) { return {.least = least}; }
constexpr Bounds within(double size) { return {-size, size}; }

constexpr PaperRun kLoop = PaperRun::kScenario, kFrames = PaperRun::kFrames;
using Figures = std::vector<PaperFigure>;

// P000 tells its errors as means of absolute values.
const Figures kFixed = {
    {"x, mean absolute error", "mm", "abs_x_mm", "5", at_most(61), at_most(1)},
    {"y, mean absolute error", "mm", "abs_y_mm", "2", at_most(43), at_most(1)},
    {"z, mean absolute error", "mm", "abs_z_mm", "28", at_most(50), at_most(5)},
    {"x, mean", "mm", "mean_x_mm", "-45 (-40 is true)"},
    {"y, mean", "mm", "mean_y_mm", "20 (20 is true)"},
    {"z, mean", "mm", "mean_z_mm", "840 (840 is true)"},
    {"fitness, mean", "", "fitness", "0.94"},
    {"found", "", "found_share", ""},
};

const Figures kFixedFrames = {
    {"x, mean absolute error", "mm", "abs_x_mm", "5", at_most(61), at_most(1)},
    {"y, mean absolute error", "mm", "abs_y_mm", "2", at_most(43), at_most(1)},
    {"z, mean absolute error", "mm", "abs_z_mm", "28", at_most(50), at_most(5)},
    {"fitness, mean", "", "fitness", "0.94"},
    {"found", "", "found_share", ""},
};

// Their figures: crab, starfish, and both again. What is allowed is the tighter of the two.
const Figures kVisits = {
    {"x, mean absolute error", "mm", "visit_x_mm", "17, 7, 17, 24", at_most(24), at_most(2)},
    {"y, mean absolute error", "mm", "visit_y_mm", "13, 23, 1, 2", at_most(24), at_most(2)},
    {"z, mean absolute error", "mm", "visit_z_mm", "2, 3, 46, 47", at_most(50), at_most(5)},
    {"visits done", "", "visits", "4", at_least(4)},
    {"fitness, mean", "", "fitness", ""},
    {"found", "", "found_share", ""},
};

const Figures kPerson = {
    {"distance, RE", "%", "distance_re", "0.304", {}, at_most(0.1)},
    {"distance, RSD", "%", "distance_rsd", "0.700", {}, at_most(0.1)},
    {"height, RE", "%", "height_re", "0.27", {}, at_most(0.1)},
    {"height, RSD", "%", "height_rsd", "0.669", {}, at_most(0.1)},
    {"width, RE", "%", "width_re", "0.188", {}, at_most(0.1)},
    {"width, RSD", "%", "width_rsd", "", {}, at_most(0.1)},
    {"distance, mean", "mm", "mean_z_mm", "4012.2"},
    {"fitness, mean", "", "fitness", "0.777"},
    {"fitness, standard deviation", "", "fitness_deviation", "0.013"},
    {"found", "", "found_share", ""},
};

const Figures kTracking = {
    {"x, RMS of the error", "mm", "rms_x_mm", "", {}, at_most(3)},
    {"y, RMS of the error", "mm", "rms_y_mm", "", {}, at_most(3)},
    {"z, RMS of the error", "mm", "rms_z_mm", "", {}, at_most(3)},
    {"x, lag at 0.05 Hz", "°", "lag_x_deg", "some", {}, within(1)},
    {"y, lag at 0.05 Hz", "°", "lag_y_deg", "some", {}, within(1)},
    {"z, lag at 1/60 Hz", "°", "lag_z_deg", "some", {}, within(1)},
    {"found", "", "found_share", ""},
};

const Figures kSweep = {
    {"x, 90° late at", "Hz", "quarter_x_hz", "", {}, at_least(1.5)},
    {"y, 90° late at", "Hz", "quarter_y_hz", "", {}, at_least(1.5)},
    {"z, 90° late at", "Hz", "quarter_z_hz", "", {}, at_least(1.5)},
    {"x, 3 dB less at", "Hz", "cutoff_x_hz", ""},
    {"y, 3 dB less at", "Hz", "cutoff_y_hz", ""},
    {"z, 3 dB less at", "Hz", "cutoff_z_hz", ""},
    {"found", "", "found_share", ""},
};

// Without the goals, to see what prediction is worth.
Figures compared(Figures figures) {
  for (PaperFigure& figure : figures) figure.goal = {};
  return figures;
}

Figures following(const char* least, const char* most, const char* mean, const char* fitness) {
  return {{"distance, least", "mm", "least_z_mm", least, {}, at_least(3900)},
          {"distance, largest", "mm", "most_z_mm", most, {}, at_most(4100)},
          {"distance, mean", "mm", "mean_z_mm", mean},
          {"least fitness by that at the start", "", "fitness_kept", fitness, {}, at_least(0.8)},
          {"found", "", "found_share", ""}};
}

const std::vector<PaperExperiment>& table() {
  static const std::vector<PaperExperiment> rows = {
      {"p000_fixed", "P000 §3.1", "an ROV holds a fixed target 185×130 mm in 5 lx for 60 s", kLoop,
       "paper_p000_fixed", "p000", kFixed, 8},
      {"p000_fixed_frames", "P000 §3.1", "the same target in single frames, from nothing", kFrames,
       "poses_dark", "p000", kFixedFrames, 0, 0, 40},
      {"p000_visits", "P000 §3.2", "an ROV visits a crab and a starfish in turn, twice, in 5 lx",
       kLoop, "visit_two", "p000", kVisits},
      {"p001_crab", "P001 §3–4", "an arm holds a crab that moves by 100 mm in 20 and 60 s", kLoop,
       "arm_track_crab", "p001", kTracking, 10, 70},
      {"p001_sweep", "P001 §3–4", "an arm's frequency response to a crab, 0.05 to 3 Hz", kLoop,
       "paper_p001_sweep", "p001", kSweep, 7},
      {"p001_sweep_unpredicted",
       "P001 §3–4",
       "the same without prediction and feed-forward",
       kLoop,
       "paper_p001_sweep",
       "p001",
       compared(kSweep),
       7,
       0,
       0,
       {"filter.predict=false", "servo.feed_forward=false"}},
      {"p004_person_frames", "P004 §4.1", "a person at 4000 mm in single frames, from nothing",
       kFrames, "paper_p004_person", "p000", kPerson, 0, 0, 60},
      {"p004_natural", "P004 §4.2", "an AGV follows a person while the light falls from 37 to 4 lx",
       kLoop, "paper_p004_natural", "p000",
       following("3740", "4283", "4005", "0.39 (the least itself)"), 6},
  };
  return rows;
}

}  // namespace

bool Bounds::any() const { return std::isfinite(least) || std::isfinite(most); }

std::span<const PaperExperiment> paper_experiments() { return table(); }

const PaperExperiment* find_paper(std::string_view name) {
  for (const PaperExperiment& experiment : table())
    if (name == experiment.name) return &experiment;
  return nullptr;
}

std::vector<std::string> method_settings(const PaperExperiment& experiment, PaperMethod method) {
  std::vector<std::string> settings(experiment.settings.begin(), experiment.settings.end());
  if (method == PaperMethod::kPapers) {
    settings.push_back(std::string("track.fitness=") + experiment.fitness);
    for (const char* setting :
         {"track.optimiser=rm_ga", "track.evaluations=540", "track.evaluations_tracking=540",
          "track.refine=false", "filter.predict=false", "servo.feed_forward=false"})
      settings.emplace_back(setting);
  }
  return settings;
}

}  // namespace gannet::world

// PaperTable: the experiments of the four papers, each one row here: what they did and measured,
// what they allow, what we are after, and how it is run in the simulated world. A new experiment is
// a scenario (or a still scene for single frames) and a row. Start-up only.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gannet::world {

// Both ends belong to it; infinite: open.
struct Bounds {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();

  bool any() const;
  bool hold(double value) const { return value >= least && value <= most; }  // NaN: no
};

struct PaperFigure {
  const char* name;     // "z, mean absolute error"
  const char* unit;     // "" for shares
  const char* measure;  // of check.hpp, or of paper_frames.hpp for single frames
  const char* theirs;   // as the paper says it; "": it gives none
  Bounds allowed = {};  // by the paper
  Bounds goal = {};     // ours
};

enum class PaperRun {
  kScenario,  // the scenario with a real gannetd, stepped
  kFrames     // single pairs of the scenario's first moment, recognised without a daemon
};

struct PaperExperiment {
  const char* name;   // as a person types it
  const char* paper;  // "P000 §3.1"
  const char* what;   // in half a sentence
  PaperRun run;
  const char* scenario;  // its name or file
  const char* fitness;   // the paper's own: p000, p001 or p002
  std::vector<PaperFigure> figures;
  double from_s = 0;                       // kScenario: figures count from then on
  double duration_s = 0;                   // kScenario; 0: the scenario's own
  int frames = 0;                          // kFrames
  std::vector<const char*> settings = {};  // "room.key=value" for gannetd, with either method
};

std::span<const PaperExperiment> paper_experiments();
const PaperExperiment* find_paper(std::string_view name);  // null: unknown

enum class PaperMethod { kOurs, kPapers };
inline constexpr const char* kPaperMethods[] = {"ours", "papers"};

// What makes a method of an experiment's config: for the papers' rm_ga with the fitness of the
// paper and the evaluations that its computer did in a frame, no refinement, no prediction.
std::vector<std::string> method_settings(const PaperExperiment& experiment, PaperMethod method);

}  // namespace gannet::world

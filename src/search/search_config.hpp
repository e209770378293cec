// Parameters of the optimisers, described once: name, default, range, sentence. Plain values;
// lengths are shares of a gene's range [0, 1], since the search room knows no metres. Start-up
// only.
#pragma once

#include <string>
#include <vector>

#include "platform/base/describe.hpp"

namespace gannet::search {

// The papers fix the coding (12 bits × 6 variables in P001 §2.6 and P002 Eq. 7; 10 bits for depth
// and 14 for the two angles in P004 §3.3), the order of the steps, and that the population lives
// on from frame to frame. They leave survival, crossover and mutation open: here each open rule is
// a choice. The default of mutation was among the best of 30 readings on test landscapes that lie
// askew to the genes' axes, as poses do. Of runs of 5,000 evaluations "one bit of 10 % of the
// children flips" finds a smooth peak in 18 % and a rugged one in 36 %, and holds a moving peak in
// 9 % of frames; "each bit of all but the elite flips with 3 %" does so in 56, 98 and 67 %.
struct RmGaConfig {
  int population = 60;  // what the papers' machine could score nine times in 33 ms
  int bits_per_gene = 12;
  std::vector<int> bits_of_three_genes = {10, 7, 7};
  std::string coding = "binary";
  double survival = 0.6;
  int elite = 1;
  std::string parents = "any_survivor";
  std::string crossover = "two_point";
  std::string mutation = "each_bit";
  double mutation_rate = 0.03;
  bool mutate_survivors = true;
  bool score_survivors_again = true;
  bool use_hint = false;
};

struct DifferentialEvolutionConfig {
  int population = 60;
  std::string strategy = "mix";
  double scale_min = 0.4;
  double scale_max = 0.9;
  double crossover = 0.9;
  double best_share = 0.1;
  double reseed_share = 0.33;
  double reseed_local = 0.5;
  double local_radius = 0.05;
};

struct CmaEsConfig {
  int population = 0;
  double sigma = 0.3;
  double sigma_hint = 0.05;
  double restart_growth = 2;
  int population_max = 72;
  double tolerance = 1e-4;
  int patience = 12;
};

// Our default: a quasi-random scan on the coarsest level, then several hypotheses that shrink in
// number as the levels grow finer, each a CMA-ES of its own.
struct GannetSearchConfig {
  double scan_share = 0.25;         // of the frame's evaluations
  int islands = 24;                 // hypotheses that leave the scan
  double island_share = 0.4;        // of the islands that go on to the next finer level
  int population = 10;              // samples of an island's generation
  double sigma_scan = 0.08;         // first step of an island from the scan
  double sigma_hint = 0.03;         // and of the one at the hint
  double apart = 0.15;              // least distance of two islands from the scan
  double evaluations_small = 6000;  // below this budget the number of islands shrinks with it
};

struct SearchConfig {
  GannetSearchConfig gannet;
  RmGaConfig rm_ga;
  DifferentialEvolutionConfig differential_evolution;
  CmaEsConfig cma_es;
};

void describe(Visitor& v, RmGaConfig& c);
void describe(Visitor& v, DifferentialEvolutionConfig& c);
void describe(Visitor& v, CmaEsConfig& c);
void describe(Visitor& v, GannetSearchConfig& c);
void describe(Visitor& v, SearchConfig& c);

}  // namespace gannet::search

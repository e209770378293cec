#include "src/search/search_config.hpp"

namespace gannet::search {

void describe(Visitor& v, RmGaConfig& c) {
  v.field("population", c.population, {.min = 4, .max = 4096, .help = "Individuals."});
  v.field("bits_per_gene", c.bits_per_gene,
          {.min = 4, .max = 16, .unit = "bit", .help = "Coding of each variable of a 6-DoF pose."});
  v.field("bits_of_three_genes", c.bits_of_three_genes,
          {.min = 4,
           .max = 16,
           .size = 3,
           .unit = "bit",
           .help = "Coding of depth and the two angles of Pb3DP; P004 shares 14 bits between the "
                   "angles, half each in our reading."});
  v.field("coding", c.coding,
          {.choices = {"binary", "gray"},
           .help = "The papers show plain binary numbers; gray makes neighbours differ by one "
                   "bit."});
  v.field("survival", c.survival,
          {.min = 0.05,
           .max = 0.95,
           .help = "Share of the population that is kept after sorting; the rest is replaced by "
                   "children."});
  v.field("elite", c.elite, {.min = 1, .max = 64, .help = "The best that mutation never touches."});
  v.field("parents", c.parents,
          {.choices = {"any_survivor", "ranked", "best_with_survivor"},
           .help = "Who has children: any two survivors, the better ones more often (linear in "
                   "rank), or the best with any survivor."});
  v.field("crossover", c.crossover,
          {.choices = {"one_point", "two_point", "uniform", "gene"},
           .help = "How two parents' bits are exchanged: behind a cut, between two cuts, each bit "
                   "by lot, or whole variables by lot."});
  v.field("mutation", c.mutation,
          {.choices = {"one_bit", "each_bit", "one_gene"},
           .help = "What mutation_rate is the probability of: an individual flips one bit, each "
                   "bit flips, or an individual draws one variable afresh."});
  v.field("mutation_rate", c.mutation_rate, {.min = 0, .max = 1, .help = "See mutation."});
  v.field("mutate_survivors", c.mutate_survivors,
          {.help = "Mutation also befalls the survivors behind the elite, not the children only."});
  v.field("score_survivors_again", c.score_survivors_again,
          {.help = "Every generation scores the whole population, as published; false saves the "
                   "survivors' share within a frame."});
  v.field("use_hint", c.use_hint,
          {.help = "The predicted pose replaces the weakest individual when a frame begins; the "
                   "papers predict nothing."});
}

void describe(Visitor& v, DifferentialEvolutionConfig& c) {
  v.field("population", c.population, {.min = 6, .max = 4096, .help = "Members."});
  v.field(
      "strategy", c.strategy,
      {.choices = {"mix", "rand_1", "current_to_best"},
       .help = "How a mutant is made; mix tosses a coin between the other two for each trial."});
  v.field("scale_min", c.scale_min,
          {.min = 0.05, .max = 2, .help = "Least factor of a difference; drawn for each trial."});
  v.field("scale_max", c.scale_max, {.min = 0.05, .max = 2, .help = "Greatest such factor."});
  v.field("crossover", c.crossover,
          {.min = 0, .max = 1, .help = "Probability that a gene comes from the mutant."});
  v.field("best_share", c.best_share,
          {.min = 0,
           .max = 1,
           .help = "current_to_best draws its best one from this share of the members; 0: always "
                   "the very best."});
  v.field("reseed_share", c.reseed_share,
          {.min = 0, .max = 0.9, .help = "Worst share of the members, replaced in every frame."});
  v.field("reseed_local", c.reseed_local,
          {.min = 0,
           .max = 1,
           .help = "Share of those that starts near the hint (or the last best), the others start "
                   "anywhere."});
  v.field("local_radius", c.local_radius,
          {.min = 0, .max = 1, .help = "Half-width of near, as a share of each gene's range."});
}

void describe(Visitor& v, CmaEsConfig& c) {
  v.field("population", c.population,
          {.min = 0, .max = 4096, .help = "Samples of a generation; 0: 4 + 3 ln(dimension)."});
  v.field("sigma", c.sigma,
          {.min = 0.001, .max = 1, .help = "First step size when nothing is known."});
  v.field("sigma_hint", c.sigma_hint,
          {.min = 0.001, .max = 1, .help = "First step size about a hint or the last best."});
  v.field("restart_growth", c.restart_growth,
          {.min = 1, .max = 4, .help = "Factor of the population at each restart in a frame."});
  v.field("population_max", c.population_max,
          {.min = 4, .max = 4096, .help = "Where that growth ends."});
  v.field("tolerance", c.tolerance,
          {.min = 1e-7,
           .max = 0.1,
           .help = "Restart when the longest axis of the distribution is shorter than this."});
  v.field("patience", c.patience,
          {.min = 2,
           .max = 1000,
           .help = "Restart after this many generations, times the "
                   "dimension, without a better one."});
}

void describe(Visitor& v, GannetSearchConfig& c) {
  v.field("scan_share", c.scan_share,
          {.min = 0.01,
           .max = 0.9,
           .help = "Share of a frame's evaluations that goes into the "
                   "coarse scan of the whole search volume."});
  v.field("islands", c.islands, {.min = 1, .max = 64, .help = "Hypotheses that leave the scan."});
  v.field("island_share", c.island_share,
          {.min = 0.05, .max = 1, .help = "Share of them that goes on to the next finer level."});
  v.field("population", c.population,
          {.min = 4, .max = 64, .help = "Samples of one hypothesis's generation."});
  v.field("sigma_scan", c.sigma_scan,
          {.min = 0.001, .max = 1, .help = "First step of a hypothesis from the scan."});
  v.field("sigma_hint", c.sigma_hint,
          {.min = 0.001, .max = 1, .help = "First step of the hypothesis at the prediction."});
  v.field("apart", c.apart,
          {.min = 0,
           .max = 1,
           .help = "Least distance of two hypotheses from the scan, as a "
                   "share of the genes' ranges."});
  v.field("evaluations_small", c.evaluations_small,
          {.min = 0,
           .max = 1e6,
           .help = "Budgets below this have proportionally fewer "
                   "hypotheses."});
}

void describe(Visitor& v, SearchConfig& c) {
  v.group("gannet", c.gannet, "Coarse to fine with several hypotheses, the default.");
  v.group("rm_ga", c.rm_ga, "The real-time multi-step genetic algorithm as published.");
  v.group("differential_evolution", c.differential_evolution,
          "Differential evolution with a persistent population.");
  v.group("cma_es", c.cma_es, "Evolution strategy that learns its covariance, with restarts.");
}

}  // namespace gannet::search

// Parameters of the optimisers, described once. Start-up only.
#pragma once

#include "platform/base/describe.hpp"

namespace gannet::search {

struct RmGaConfig {};
struct DifferentialEvolutionConfig {};
struct CmaEsConfig {};

struct SearchConfig {
  RmGaConfig rm_ga;
  DifferentialEvolutionConfig differential_evolution;
  CmaEsConfig cma_es;
};

void describe(Visitor& v, SearchConfig& c);

}  // namespace gannet::search

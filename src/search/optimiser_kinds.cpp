#include "src/search/optimiser_kinds.hpp"

#include "src/search/cma_es.hpp"
#include "src/search/differential_evolution.hpp"
#include "src/search/gannet_search.hpp"
#include "src/search/rm_ga.hpp"

namespace gannet::search {
namespace {

struct Kind {
  std::string_view name;
  std::unique_ptr<Optimiser> (*make)(int dimension, const SearchConfig& config, std::uint64_t seed);
};

template <class Method, auto kGroup>
std::unique_ptr<Optimiser> make(int dimension, const SearchConfig& config, std::uint64_t seed) {
  return std::make_unique<Method>(dimension, config.*kGroup, seed);
}

// A new optimiser is a line here and a group in SearchConfig.
constexpr Kind kKinds[] = {
    {"gannet", make<GannetSearch, &SearchConfig::gannet>},
    {"rm_ga", make<RmGa, &SearchConfig::rm_ga>},
    {"differential_evolution", make<DifferentialEvolution, &SearchConfig::differential_evolution>},
    {"cma_es", make<CmaEs, &SearchConfig::cma_es>},
};

}  // namespace

Result<std::unique_ptr<Optimiser>> make_optimiser(std::string_view name, int dimension,
                                                  const SearchConfig& config, std::uint64_t seed) {
  if (dimension < 1 || dimension > kMaxDimension) {
    return Error{"search: " + std::to_string(dimension) + " genes are outside [1, " +
                 std::to_string(kMaxDimension) + "]"};
  }
  for (const Kind& kind : kKinds) {
    if (kind.name == name) return kind.make(dimension, config, seed);
  }
  std::string known;
  for (const Kind& kind : kKinds) known += (known.empty() ? "" : ", ") + std::string(kind.name);
  return Error{"search: unknown optimiser \"" + std::string(name) + "\"; known are " + known};
}

std::vector<std::string> optimiser_names() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

}  // namespace gannet::search

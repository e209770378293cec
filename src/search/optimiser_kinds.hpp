// The kinds of optimisers, by the names that configs and command lines use. Start-up only.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/base/result.hpp"
#include "src/search/optimiser.hpp"
#include "src/search/search_config.hpp"

namespace gannet::search {

// dimension 1 … 8 genes. Error: unknown name (the known ones are listed), dimension outside. The
// caller owns the optimiser; the same name, config and seed propose the same candidates.
Result<std::unique_ptr<Optimiser>> make_optimiser(std::string_view name, int dimension,
                                                  const SearchConfig& config, std::uint64_t seed);

std::vector<std::string> optimiser_names();

}  // namespace gannet::search

// Which kernels run: the best that this processor has, or one by name (to compare them; all give
// the same bits). Start-up only.
#pragma once

#include <span>
#include <string_view>

#include "src/vision/kernels/kernels.hpp"

namespace gannet::vision {

// Tables that can run here, the truth first, the best last.
std::span<const Kernels* const> kernels_here();

// Null when there is none of that name, or this processor lacks it. "" and "auto": the best.
const Kernels* find_kernels(std::string_view name);

}  // namespace gannet::vision

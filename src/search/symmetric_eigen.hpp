// Eigenvalues and eigenvectors of a small symmetric matrix by cyclic Jacobi rotations: additions,
// divisions and sqrt in a fixed order, so the same bits on every machine, which a vectorised
// library does not promise. RT safe.
#pragma once

#include <array>

#include "src/search/population.hpp"

namespace gannet::search {

using SmallVector = std::array<double, kMaxDimension>;
using SmallMatrix = std::array<SmallVector, kMaxDimension>;  // [row][column]

// matrix = vectors · diag(values) · vectorsᵀ, of the leading n × n block; the columns of vectors
// are orthonormal. Only finite, symmetric input.
void symmetric_eigen(const SmallMatrix& matrix, int n, SmallMatrix& vectors, SmallVector& values);

}  // namespace gannet::search

// What one evaluation costs when it is put together from OpenCV's functions. Benchmarks only, one
// thread.
#pragma once

#include "tests/bench/results.hpp"

namespace gannet::bench {

void evaluation_with_opencv(Results& results);

}  // namespace gannet::bench

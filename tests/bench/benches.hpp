// The groups of the benchmark; each adds its rows to the results. Benchmarks only, one thread.
#pragma once

#include "tests/bench/results.hpp"

namespace gannet::bench {

// quick: small pictures and few turns, to see that all of it runs; the figures mean nothing then.
struct Options {
  bool quick = false;
  int scenes = 60;  // of the acquisition
  int trials = 16;  // of the accuracy, for each pose and noise
  int turns() const { return quick ? 3 : 41; }
  int width() const { return quick ? 320 : 640; }
  int height() const { return quick ? 240 : 480; }
  int candidates() const { return quick ? 32 : 256; }
};

void bench_kernels(const Options& options, Results& results);
void bench_fitness(const Options& options, Results& results);
void bench_handover(const Options& options, Results& results);
void bench_frame(const Options& options, Results& results);
void bench_acquisition(const Options& options, Results& results);
void bench_decision(const Options& options, Results& results);
void bench_accuracy(const Options& options, Results& results);
void bench_refraction(const Options& options, Results& results);
void bench_relief(const Options& options, Results& results);
void bench_footprint(const Options& options, Results& results);
void bench_render(const Options& options, Results& results);
void bench_jitter(const Options& options, Results& results);

}  // namespace gannet::bench

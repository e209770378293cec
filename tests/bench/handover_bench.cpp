// Hand-overs between two pinned threads, and leases.
#include <atomic>
#include <cstdlib>

#include "platform/base/latest_value.hpp"
#include "platform/base/lease_pool.hpp"
#include "platform/base/ring.hpp"
#include "platform/linux/cpu.hpp"
#include "platform/linux/thread.hpp"
#include "src/core/pose_estimate.hpp"
#include "tests/bench/benches.hpp"

namespace gannet::bench {
namespace {

constexpr int kWays = 3;

// Three ways to hand a number there and back: a bare atomic, rings, LatestValues.
struct Table {
  alignas(64) std::atomic<std::uint64_t> there{0};
  alignas(64) std::atomic<std::uint64_t> back{0};
  SpscRing<PoseEstimate> ring_there{8}, ring_back{8};
  LatestValue<PoseEstimate> value_there, value_back;
  std::atomic<bool> over{false};
};

bool pass(Table& t, int way, std::uint64_t n, bool first) {
  PoseEstimate estimate;
  estimate.frame_number = n;
  if (way == 0) (first ? t.there : t.back).store(n, std::memory_order_release);
  if (way == 1) return (first ? t.ring_there : t.ring_back).push(estimate);
  if (way == 2) (first ? t.value_there : t.value_back).write(estimate);
  return true;
}

// Waits for number n; false when all is over.
bool take(Table& t, int way, std::uint64_t n, bool first) {
  PoseEstimate estimate;
  while (!t.over.load(std::memory_order_relaxed)) {
    if (way == 0 && (first ? t.there : t.back).load(std::memory_order_acquire) == n) return true;
    if (way == 1 && (first ? t.ring_there : t.ring_back).pop(estimate)) return true;
    if (way == 2) {
      auto& value = first ? t.value_there : t.value_back;
      if (value.fresh() && value.read().frame_number == n) return true;
    }
  }
  return false;
}

struct Plan {
  int turns, rounds;
  std::array<std::vector<double>, kWays> ns;  // per hand-over
};

void ping(Table& t, Plan& plan) {
  std::uint64_t n = 0;
  for (int turn = -1; turn < plan.turns; ++turn) {
    for (int way = 0; way < kWays; ++way) {
      const double start = wall_ns();
      for (int i = 0; i < plan.rounds; ++i) {
        ++n;
        pass(t, way, n, true);
        take(t, way, n, false);
      }
      const double spent = (wall_ns() - start) / (2.0 * plan.rounds);
      if (turn >= 0) plan.ns[static_cast<std::size_t>(way)].push_back(spent);
    }
  }
  t.over.store(true);
}

void pong(Table& t, const Plan& plan) {
  std::uint64_t n = 0;
  for (;;) {
    for (int way = 0; way < kWays; ++way) {
      for (int i = 0; i < plan.rounds; ++i) {
        ++n;
        if (!take(t, way, n, true)) return;
        pass(t, way, n, false);
      }
    }
  }
}

// Two cores that we may use; false if there are none.
bool two_cores(int& a, int& b) {
  a = b = -1;
  for (int core = 0; core < 1024 && b < 0; ++core) {
    if (linux_os::may_run_on(core)) (a < 0 ? a : b) = core;
  }
  return b >= 0;
}

void bench_threads(const Options& options, Results& results) {
  int a = 0, b = 0;
  if (!two_cores(a, b)) {
    results.add({"between threads", "", {}, 0, {}, "skipped: only one core may be used"});
    return;
  }
  Plan plan = {options.quick ? 3 : 301, options.quick ? 20 : 200, {}};
  const auto table = std::make_unique<Table>();
  auto other = linux_os::Thread::start("pong", {.core = b}, [&] { pong(*table, plan); });
  auto own = linux_os::Thread::start("ping", {.core = a}, [&] { ping(*table, plan); });
  if (!other || !own) std::abort();
  own->join();
  other->join();
  const char* names[kWays] = {"bare atomic", "SpscRing<PoseEstimate>", "LatestValue<PoseEstimate>"};
  for (std::size_t way = 0; way < kWays; ++way) {
    Row row = {names[way], "ns", spread_of(plan.ns[way]), plan.turns, {}, ""};
    row.note = "least " + std::to_string(static_cast<int>(quantile(plan.ns[way], 0))) + " ns";
    if (way > 0) {
      row.ratios.push_back(
          {"times the bare atomic", spread_of(ratios_of(plan.ns[way], plan.ns[0]))});
    }
    results.add(row);
  }
}

}  // namespace

void bench_handover(const Options& options, Results& results) {
  results.group("hand-overs",
                "Wall time of one hand-over: half of a round trip between two pinned, polling "
                "threads, mean of 200 round trips a trial; trials in which another process had a "
                "core lie above the upper quartile. Leases: lend and return on one thread, CPU "
                "time.");
  bench_threads(options, results);
  LeasePool pool(8);
  std::atomic<std::uint64_t> word{0};
  constexpr int kRounds = 20000;
  const auto times = interleave({{"two atomic operations",
                                  [&](int) {
                                    for (int i = 0; i < kRounds; ++i) {
                                      word.fetch_or(1, std::memory_order_release);
                                      word.fetch_and(~std::uint64_t{1}, std::memory_order_relaxed);
                                    }
                                    return kRounds;
                                  }},
                                 {"LeasePool",
                                  [&](int) {
                                    int sum = 0;
                                    for (int i = 0; i < kRounds; ++i) {
                                      const Lease lease = pool.lend();
                                      sum += lease.slot();
                                    }
                                    consume(sum);
                                    return kRounds;
                                  }}},
                                options.turns());
  results.add({"LeasePool lend + return",
               "ns",
               spread_of(times[1]),
               options.turns(),
               {{"times two atomic operations", spread_of(ratios_of(times[1], times[0]))}},
               ""});
}

}  // namespace gannet::bench

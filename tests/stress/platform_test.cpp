// The hand-overs between threads, pushed hard for a short time; run also under ThreadSanitizer.
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "platform/base/latest_value.hpp"
#include "platform/base/lease_pool.hpp"
#include "platform/base/ring.hpp"
#include "platform/linux/thread.hpp"
#include "platform/linux/worker_pool.hpp"

namespace gannet {
namespace {

#if defined(__SANITIZE_THREAD__)
constexpr int kScale = 1;
#else
constexpr int kScale = 10;
#endif

TEST(StressRing, delivers_everything_once_and_in_order) {
  SpscRing<std::unique_ptr<int>> sut(16);
  constexpr int kElements = 30000 * kScale;
  std::thread writer([&] {
    for (int i = 0; i < kElements; ++i) {
      auto element = std::make_unique<int>(i);
      while (!sut.push(std::move(element))) std::this_thread::yield();
    }
  });
  std::unique_ptr<int> element;
  for (int i = 0; i < kElements; ++i) {
    while (!sut.pop(element)) std::this_thread::yield();
    ASSERT_EQ(*element, i);
    EXPECT_LE(sut.size(), sut.capacity());
  }
  writer.join();
  EXPECT_FALSE(sut.pop(element));
}

TEST(StressLatestValue, is_never_torn_and_never_older) {
  struct Wide {
    std::array<std::int64_t, 40> words = {};
  };
  LatestValue<Wide> sut;
  constexpr int kWrites = 50000 * kScale;
  std::thread writer([&] {
    for (int i = 1; i <= kWrites; ++i) {
      sut.back().words.fill(i);
      sut.publish();
    }
  });
  std::int64_t newest = 0;
  while (newest < kWrites) {
    const Wide& value = sut.read();
    for (const std::int64_t word : value.words) ASSERT_EQ(word, value.words[0]);
    ASSERT_GE(value.words[0], newest);
    newest = value.words[0];
    if (!sut.fresh()) std::this_thread::yield();
  }
  writer.join();
}

TEST(StressLeasePool, no_slot_has_two_holders) {
  LeasePool pool(6);
  std::array<int, 6> written = {};  // each touched by its holder alone: TSan would see a race
  SpscRing<Lease> to_vision(4), to_archive(4);
  std::atomic<bool> stop{false};
  std::thread vision([&] {
    Lease lease;
    while (!stop) {
      if (!to_vision.pop(lease)) {
        std::this_thread::yield();
        continue;
      }
      written[static_cast<std::size_t>(lease.slot())] += 1;
      if (!to_archive.push(std::move(lease))) lease = Lease();  // full: goes home from here
    }
  });
  std::thread archive([&] {
    Lease lease;
    while (!stop) {
      if (to_archive.pop(lease)) written[static_cast<std::size_t>(lease.slot())] += 1;
      lease = Lease();
      std::this_thread::yield();
    }
  });
  int lent = 0;
  while (lent < 10000 * kScale) {
    Lease lease = pool.lend();
    if (!lease.valid()) {
      std::this_thread::yield();
      continue;
    }
    ++lent;
    written[static_cast<std::size_t>(lease.slot())] = 0;
    while (!to_vision.push(std::move(lease))) std::this_thread::yield();
  }
  stop = true;
  vision.join();
  archive.join();
  Lease rest;
  while (to_vision.pop(rest) || to_archive.pop(rest)) rest = Lease();
  EXPECT_EQ(pool.free_count(), 6);
}

TEST(StressWorkerPool, every_piece_once_and_its_results_seen) {
  auto sut = linux_os::WorkerPool::create("stress", {{}, {}});
  ASSERT_TRUE(sut);
  std::vector<int> results(64, 0);  // plain: TSan would see an unordered write
  for (int round = 1; round <= 2000 * kScale; ++round) {
    const int n = 1 + round % 64;
    (*sut)->for_each(n, [&](int index, int) { results[static_cast<std::size_t>(index)] += round; });
    for (int i = 0; i < n; ++i) {
      ASSERT_EQ(results[static_cast<std::size_t>(i)], round) << "piece " << i;
      results[static_cast<std::size_t>(i)] = 0;
    }
  }
}

TEST(StressWorkerPool, starts_and_stops_at_any_moment) {
  for (int i = 0; i < 100; ++i) {
    auto sut = linux_os::WorkerPool::create("brief", {{}, {}});
    ASSERT_TRUE(sut);
    std::atomic<int> pieces{0};
    if (i % 2 == 0) (*sut)->for_each(i, [&](int, int) { ++pieces; });
    EXPECT_EQ(pieces, i % 2 == 0 ? i : 0);
  }
}

}  // namespace
}  // namespace gannet

#include "platform/linux/worker_pool.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <climits>
#include <cstdint>

#include "platform/linux/cpu.hpp"

namespace gannet::linux_os {
namespace {

using Word = std::atomic<std::uint32_t>;

void sleep_while(Word& word, std::uint32_t value) {
  syscall(SYS_futex, &word, FUTEX_WAIT_PRIVATE, value, nullptr, nullptr, 0);
}
void wake(Word& word, int threads) {
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, threads, nullptr, nullptr, 0);
}
void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

// A job as one word: epoch (24 bits), pieces (20), next piece to take (20). Taking a piece is one
// compare-exchange, so nobody ever takes one of another job.
constexpr int kBits = 20;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
std::uint64_t ticket_of(std::uint64_t epoch, int n) {
  return epoch << (2 * kBits) | static_cast<std::uint64_t>(n) << kBits;
}

}  // namespace

struct WorkerPool::Shared {
  // Written before ticket is released, read after it is acquired with a piece taken, and not
  // rewritten before that piece is done.
  void (*work)(void*, int, int) = nullptr;
  void* context = nullptr;
  alignas(64) std::atomic<std::uint64_t> ticket{0};
  alignas(64) Word done{0};  // pieces done of this job
  Word caller_sleeps{0};
  alignas(64) Word epoch{0};  // the workers' doorbell
  Word sleepers{0};
  std::atomic<bool> stop{false};
  int spins = 0;

  // Of n pieces one, its index; false: none left.
  bool take_piece(int& index, std::uint32_t& n) {
    std::uint64_t seen = ticket.load(std::memory_order_relaxed);
    while ((seen & kMask) < (seen >> kBits & kMask)) {
      // Acquire pairs with the release in run(): work and context are this job's.
      if (ticket.compare_exchange_weak(seen, seen + 1, std::memory_order_acquire,
                                       std::memory_order_relaxed)) {
        index = static_cast<int>(seen & kMask);
        n = static_cast<std::uint32_t>(seen >> kBits & kMask);
        return true;
      }
    }
    return false;
  }

  // Takes pieces until there are none.
  void help(int worker) {
    int index = 0;
    std::uint32_t n = 0;
    while (take_piece(index, n)) {
      work(context, index, worker);
      // Release pairs with run()'s acquire: results are there. Seq_cst order against
      // caller_sleeps: either we see that the caller sleeps or it sees our count.
      const bool last = done.fetch_add(1, std::memory_order_seq_cst) + 1 == n;
      if (last && caller_sleeps.load(std::memory_order_seq_cst) != 0) wake(done, 1);
    }
  }

  void worker_body(int worker) {
    std::uint32_t served = 0;
    while (!stop.load(std::memory_order_acquire)) {
      help(worker);
      for (int i = 0; i < spins && epoch.load(std::memory_order_relaxed) == served; ++i) relax();
      // Register interest, look again, then sleep: seq_cst against ring().
      sleepers.fetch_add(1, std::memory_order_seq_cst);
      if (epoch.load(std::memory_order_seq_cst) == served) sleep_while(epoch, served);
      sleepers.fetch_sub(1, std::memory_order_relaxed);
      served = epoch.load(std::memory_order_acquire);
    }
  }

  void ring(int threads) {
    epoch.fetch_add(1, std::memory_order_seq_cst);
    if (sleepers.load(std::memory_order_seq_cst) != 0) wake(epoch, threads);
  }

  void wait_for(std::uint32_t pieces) {
    for (int i = 0; i < spins; ++i) {
      if (done.load(std::memory_order_acquire) == pieces) return;
      relax();
    }
    caller_sleeps.store(1, std::memory_order_seq_cst);
    std::uint32_t now = done.load(std::memory_order_seq_cst);
    while (now != pieces) {
      sleep_while(done, now);
      now = done.load(std::memory_order_acquire);
    }
    caller_sleeps.store(0, std::memory_order_relaxed);
  }
};

WorkerPool::WorkerPool() : shared_(std::make_unique<Shared>()) {}

Result<std::unique_ptr<WorkerPool>> WorkerPool::create(const std::string& name,
                                                       const std::vector<ThreadConfig>& helpers) {
  std::unique_ptr<WorkerPool> pool(new WorkerPool());
  Shared* shared = pool->shared_.get();
  // About 20 µs, if every thread of the pool and one more can have a core.
  shared->spins = core_count() > static_cast<int>(helpers.size()) + 1 ? 500 : 0;
  for (std::size_t i = 0; i < helpers.size(); ++i) {
    const int worker = static_cast<int>(i) + 1;
    auto thread = Thread::start(name + "-" + std::to_string(worker), helpers[i],
                                [shared, worker] { shared->worker_body(worker); });
    if (!thread) return thread.error();
    pool->threads_.push_back(std::move(*thread));
  }
  return pool;
}

WorkerPool::~WorkerPool() {
  shared_->stop.store(true, std::memory_order_release);
  shared_->epoch.fetch_add(1, std::memory_order_seq_cst);
  wake(shared_->epoch, INT_MAX);
  threads_.clear();
}

int WorkerPool::workers() const { return static_cast<int>(threads_.size()) + 1; }

void WorkerPool::run(int n, void (*work)(void*, int, int), void* context) {
  assert(n >= 0 && static_cast<std::uint64_t>(n) <= kMask);
  Shared& shared = *shared_;
  shared.work = work;
  shared.context = context;
  // Relaxed: every piece of the job before is done, nobody adds to it until the ticket is out.
  shared.done.store(0, std::memory_order_relaxed);
  const std::uint64_t epoch = (shared.ticket.load(std::memory_order_relaxed) >> (2 * kBits)) + 1;
  shared.ticket.store(ticket_of(epoch, n), std::memory_order_release);
  if (n > 1 && !threads_.empty()) shared.ring(n - 1);
  shared.help(0);
  shared.wait_for(static_cast<std::uint32_t>(n));
}

}  // namespace gannet::linux_os

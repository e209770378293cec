// WorkerPool: threads that help one caller with pieces of work; the caller works too. Hand-over is
// by futex, with a bounded spin only where there is a core to spare. A worker that wakes late
// delays nobody: run() waits for pieces that were taken, not for threads.
// create is start-up only; run belongs to one thread and is RT safe.
#pragma once

#include <memory>
#include <vector>

#include "platform/base/parallel.hpp"
#include "platform/base/result.hpp"
#include "platform/linux/thread.hpp"

namespace gannet::linux_os {

class WorkerPool final : public Parallel {
 public:
  // One thread beside the caller for each entry. Names are "<name>-1" and so on.
  static Result<std::unique_ptr<WorkerPool>> create(const std::string& name,
                                                    const std::vector<ThreadConfig>& helpers);
  ~WorkerPool() override;

  int workers() const override;
  // n at most 2²⁰ − 1.
  void run(int n, void (*work)(void* context, int index, int worker), void* context) override;

 private:
  struct Shared;
  WorkerPool();
  std::unique_ptr<Shared> shared_;
  std::vector<Thread> threads_;
};

}  // namespace gannet::linux_os

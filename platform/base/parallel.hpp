// Parallel: runs n independent pieces of work and returns when all are done. Pure rooms are given
// one; who does the work (this thread, a pinned pool) is the caller's choice. RT safe.
#pragma once

#include <type_traits>

namespace gannet {

class Parallel {
 public:
  virtual ~Parallel() = default;
  virtual int workers() const = 0;  // >= 1
  // Calls work(context, index, worker) for each index in [0, n), worker in [0, workers()).
  // The order is not defined: results must not depend on it.
  virtual void run(int n, void (*work)(void* context, int index, int worker), void* context) = 0;

  template <class F>
  void for_each(int n, F&& f) {
    using G = std::remove_reference_t<F>;
    run(
        n, [](void* c, int i, int w) { (*static_cast<G*>(c))(i, w); },
        const_cast<void*>(static_cast<const void*>(&f)));
  }
};

// All work on the calling thread, in order.
class Serial final : public Parallel {
 public:
  int workers() const override { return 1; }
  void run(int n, void (*work)(void*, int, int), void* context) override {
    for (int i = 0; i < n; ++i) work(context, i, 0);
  }
};

}  // namespace gannet

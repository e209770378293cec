// The malloc trap: this test binary's malloc, free and friends count and trace every call that a
// thread makes while it is in a real-time section. Under a sanitizer, which has its own malloc,
// there is no trap and trap_works() is false.
#pragma once

namespace gannet::test {

bool trap_works();
// Calls caught since the start, of all threads. The first few are traced to standard error.
int trapped_calls();

// The calling thread is in a real-time section while one of these lives.
class RtSection {
 public:
  RtSection();
  ~RtSection();
  RtSection(const RtSection&) = delete;
  RtSection& operator=(const RtSection&) = delete;
};

}  // namespace gannet::test

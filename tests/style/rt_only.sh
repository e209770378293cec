#!/bin/bash
# The poisoned names of platform/base/rt_only.hpp do not compile behind it, each is caught by each
# compiler that is here, and every loop of the daemon includes it last.
set -u
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0
tell() { # ok? what
  if [ "$1" = yes ]; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAIL  $2"; fi
}

# name, a use of it
uses='malloc|void* p = malloc(1);
new|int* p = new int;
make_unique|auto p = std::make_unique<int>(1);
printf|printf("x");
snprintf|char t[2]; snprintf(t, 2, "x");
fopen|auto f = fopen("x", "r");
mutex|std::mutex m;
condition_variable|std::condition_variable c;
sleep_for|std::this_thread::sleep_for(std::chrono::seconds(1));
throw|throw 1;'
for compiler in g++ clang++-14; do
  if ! command -v "$compiler" >/dev/null; then
    skipped=$((skipped + 1)); echo "SKIP  no $compiler here"
    continue
  fi
  compile() { "$compiler" -std=c++20 -I. -fsyntax-only "$work/use.cpp" >"$work/out" 2>&1; }
  head='#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>
#include "platform/base/rt_only.hpp"'
  printf '%s\nint f(int x) { return x + 1; }\n' "$head" >"$work/use.cpp"
  if compile; then tell yes; else tell no "$compiler: innocent code does not compile"; fi
  while IFS='|' read -r name use; do
    printf '%s\nvoid f() { %s }\n' "$head" "$use" >"$work/use.cpp"
    if ! compile && grep -q poisoned "$work/out"; then tell yes
    else tell no "$compiler: $name compiles behind rt_only.hpp"; fi
  done <<<"$uses"
done

for loop in capture vision servo; do
  file=src/daemon/${loop}_loop.cpp
  if [ "$(grep '^#include' "$file" | tail -n 1)" = '#include "platform/base/rt_only.hpp"' ]; then tell yes
  else tell no "$file: its last #include is not platform/base/rt_only.hpp"; fi
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]

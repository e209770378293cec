#!/bin/bash
# determinism.sh [SCENARIO]: the same scenario twice with the same seed gives the same bits, in every
# file of its results. Exit 1 if not.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=${1:-estop}
results=build/hil/results/$name
once() { tests/hil/run "$name" >/dev/null || true; [ -e "$results/rc" ]; }
once
rm -rf "$results.first"
cp -a "$results" "$results.first"
once
if diff -rq "$results.first" "$results"; then
  echo "$name: $(find "$results" -type f | wc -l) files, the same bits twice"
else
  exit 1
fi

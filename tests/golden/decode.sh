#!/bin/bash
# What tests/hil/decode.sh tells of two kept pieces of recorded buses is what it told when they were
# kept: foreign programs' counts, not ours. recorded_cia402: eight drives being set up, the same when
# all are operational, and by hand a refused SDO and an emergency at the end; recorded_dronecan: eight
# ESCs around an error frame, which belongs to nobody. Skips without tshark or python-can.
set -u
cd "$(dirname "$0")/../.." || exit 2
command -v tshark >/dev/null || { echo "no tshark"; exit 77; }
/usr/bin/python3 -c 'import can' 2>/dev/null || { echo "no python-can (python3-can)"; exit 77; }
passed=0 failed=0
for bus in cia402 dronecan; do
  kept=tests/golden/recorded_$bus
  if diff "$kept/decoded" <(tests/hil/decode.sh "$kept"); then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAIL  $bus"
  fi
done
echo "$passed passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]

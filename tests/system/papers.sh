#!/bin/bash
# The way from an experiment of the papers to the page: the cheapest one with two seeds, by the
# commands that --jobs prints, joined and shown; what must be refused is.
set -eu
export LC_ALL=C
bin=${GANNET_BUILD:-build/release}/bin
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
fail() { echo "papers: $*" >&2; exit 1; }

"$bin/gannet-world" paper p004_person_frames --jobs "$dir/runs" --seeds 2 >"$dir/jobs"
[ "$(wc -l <"$dir/jobs")" -eq 2 ] || fail "two jobs were wanted: $(cat "$dir/jobs")"
sh -e "$dir/jobs" >"$dir/log" 2>&1 || fail "a job broke off: $(cat "$dir/log")"
"$bin/gannet" campaign merge "$dir"/runs/*.json --commit none -o "$dir/results.json" >/dev/null
"$bin/gannet" campaign report "$dir/results.json" -o "$dir/report.html" >"$dir/table" ||
  fail "outside what the paper allows: $(cat "$dir/table")"
grep -q 'distance, RSD, %.*0\.700.*2 of 2' "$dir/table" ||
  fail "the distance does not repeat within 0.1 % in both seeds: $(cat "$dir/table")"
grep -q '<table' "$dir/report.html" || fail "the page holds no table"

code=0
"$bin/gannet" campaign merge "$dir"/runs/*.json "$dir/runs/p004_person_frames.ours.1.json" \
  -o "$dir/twice.json" 2>/dev/null || code=$?
[ "$code" -eq 2 ] && [ ! -e "$dir/twice.json" ] || fail "the same run twice was not refused"
code=0
"$bin/gannet" campaign merge "$dir/jobs" -o "$dir/none.json" 2>/dev/null || code=$?
[ "$code" -eq 2 ] || fail "a file of another kind was not refused"
code=0
"$bin/gannet-world" paper p999 2>/dev/null || code=$?
[ "$code" -eq 2 ] || fail "an unknown experiment was not refused"

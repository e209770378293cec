#!/bin/bash
# fuzz.sh DIR SECONDS: runs every fuzzer in DIR for so long, one after the other. Prints a line each;
# exit 1 if one found something.
set -u
dir=$1 seconds=$2
pictures=tests/system/pictures
found=0
for fuzzer in "$dir"/*; do
  [ -x "$fuzzer" ] && [ ! -d "$fuzzer" ] || continue
  name=${fuzzer##*/}
  corpus=build/fuzz/corpus/$name log=build/fuzz/$name.log
  mkdir -p "$corpus"
  case $name in png) cp -n "$pictures"/*.png "$corpus" ;; esac
  if "$fuzzer" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/$name-" "$corpus" >"$log" 2>&1; then
    printf '  %-16s %9s runs, %5s inputs kept\n' "$name" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" "$(find "$corpus" -type f | wc -l)"
  else
    found=1
    printf '  %-16s FOUND SOMETHING, see %s\n' "$name" "$log"
    grep -E 'ERROR|SUMMARY|runtime error|Test unit written' "$log" | head -n 6
    input=$(sed -n 's/.*Test unit written to //p' "$log" | tail -n 1)
    [ -z "$input" ] || printf '    repeat: %s %s\n' "$fuzzer" "$input"
  fi
done
exit $found

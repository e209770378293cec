#!/bin/bash
# run_tests.sh BUILD: runs every test binary below BUILD/tests and every script of tests/{style,
# golden,system}; counts single tests where the runner prints them, prints what failed, and ends
# with "N passed, N failed, N skipped". Exit 0 only if none failed and some passed.
set -u
build=$1
export GANNET_BUILD=$build
passed=0 failed=0 skipped=0
failures=()
log=$build/tests/log
mkdir -p "$log"

count() { grep -cE "$1" "$2" || true; }

run_binary() {
  local name=$1 out=$log/${1//\//_}.txt
  timeout 900 "$build/tests/$name/run" --gtest_brief=0 >"$out" 2>&1
  local code=$? ok bad skip
  ok=$(count '^\[       OK \]' "$out")
  bad=$(count '^\[  FAILED  \] .* \([0-9]+ ms\)' "$out")
  skip=$(count '^\[  SKIPPED \] .* \([0-9]+ ms\)' "$out")
  if [ $code -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi  # it crashed or hung
  report "$name" $code "$ok" "$bad" "$skip" "$out"
}

run_script() {
  local script=$1 out
  out=$log/$(echo "${1%.sh}" | tr / _).txt
  timeout 900 "$script" >"$out" 2>&1
  local code=$? ok=0 bad=0 skip=0 last
  last=$(grep -E '^[0-9]+ passed, [0-9]+ failed, [0-9]+ skipped$' "$out" | tail -n 1)
  if [ -n "$last" ]; then
    read -r ok _ bad _ skip _ <<<"${last//,/}"
    if [ $code -ne 0 ] && [ "$bad" -eq 0 ]; then bad=1; fi
  elif [ $code -eq 0 ]; then ok=1
  elif [ $code -eq 77 ]; then skip=1
  else bad=1
  fi
  report "${script#tests/}" $code "$ok" "$bad" "$skip" "$out"
}

report() {
  local name=$1 code=$2 ok=$3 bad=$4 skip=$5 out=$6
  passed=$((passed + ok)) failed=$((failed + bad)) skipped=$((skipped + skip))
  printf '  %-34s %4d passed' "$name" "$ok"
  [ "$skip" -eq 0 ] || printf ', %d skipped' "$skip"
  if [ "$bad" -ne 0 ]; then
    printf ', %d FAILED (exit %d, %s)' "$bad" "$code" "$out"
    failures+=("$out")
  fi
  printf '\n'
}

for binary in $(cd "$build/tests" && find . -name run -type f -printf '%P\n' | sort); do
  # What has no source any more, and benchmarks, are not tests.
  name=${binary%/run}
  [ -d "tests/$name" ] && [ "$name" != bench ] && [ "$name" != report ] && run_binary "$name"
done
for script in tests/style/*.sh tests/golden/*.sh tests/system/*.sh; do
  [ -x "$script" ] && run_script "$script"
done
for out in "${failures[@]:-}"; do
  [ -n "$out" ] || continue
  echo "---- $out"
  grep -nE 'FAILED|Failure|rror|fail|Sanitizer' "$out" | head -n 40
  tail -n 25 "$out"
done
echo "$passed passed, $failed failed, $skipped skipped" | tee "$build/tests/summary"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]

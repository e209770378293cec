#!/bin/bash
# run.sh BUILD OUT SEEDS METHOD [ONLY]: runs the papers' experiments, a process for each core, joins
# their results into OUT/results.json and shows them as OUT/report.html. METHOD: ours, papers, both.
# Exit 1 if a run broke off or our method is outside what a paper allows.
set -euo pipefail
export LC_ALL=C
build=$1 out=$2 seeds=$3 method=$4 only=${5:-}
mkdir -p "$out/runs"
rm -f "$out"/runs/*.json "$out"/runs/*.log
# shellcheck disable=SC2086
"$build/bin/gannet-world" paper $only --jobs "$out/runs" --seeds "$seeds" --method "$method" \
  >"$out/jobs"
total=$(wc -l <"$out/jobs")
done=0
start=$SECONDS
# Each job tells its end by a line; what it printed is kept beside its result.
while read -r code job; do
  done=$((done + 1))
  spent=$((SECONDS - start))
  left=$((spent * (total - done) / done))
  word=done
  [ "$code" -eq 0 ] || word="BROKE OFF ($code)"
  printf 'papers  %d/%d  %d:%02d left  %s: %s\n' "$done" "$total" $((left / 60)) $((left % 60)) \
    "$(basename "${job##* -o }" .json)" "$word"
  [ "$code" -eq 0 ] || echo "$job" >>"$out/runs/failed.log"
done < <(xargs -d '\n' -P "$(nproc)" -I{} sh -c \
  'job=$1; file=${job##* -o }; $job >"${file%.json}.log" 2>&1; echo "$? $job"' sh {} <"$out/jobs")
commit=$(git describe --always --dirty 2>/dev/null || true)
"$build/bin/gannet" campaign merge "$out"/runs/*.json --commit "$commit" -o "$out/results.json"
verdict=0
"$build/bin/gannet" campaign report "$out/results.json" -o "$out/report.html" || verdict=$?
if [ -e "$out/runs/failed.log" ]; then
  echo "papers: broke off; their words are in the .log files of $out/runs:" >&2
  cat "$out/runs/failed.log" >&2
  verdict=1
fi
exit "$verdict"

#!/bin/bash
# The robustness report with one pair a cell of one plane: it runs, its page holds its maps, and the
# same seed gives the same result on one thread and on two. What it says of recognition is for
# `make report`; here only the easiest cell must be right. Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
report=$(realpath "${GANNET_BUILD:-build/release}")/tests/report/run
[ -x "$report" ] || { echo "no $report: run make tests first"; exit 77; }
export GANNET_ASSETS=none  # drawn pictures: the same everywhere
programs  # a folder of its own

few=(--only clutter --trials 1 --evaluations 6000)
check 'it runs' "$report" "${few[@]}" --workers 2 --out two >out.txt 2>err.txt
check 'the page has five maps of each method' test "$(grep -c '<svg ' two/report.html)" -eq 10
check 'nothing in it is loaded from elsewhere' test "$(grep -cE 'src="http|href=' two/report.html)" -eq 0
"$report" "${few[@]}" --workers 1 --out one >out.txt 2>err.txt
check 'one thread finds the same as two' cmp -s one/results.json two/results.json
"$report" "${few[@]}" --seed 2 --out other >out.txt 2>err.txt
check 'another seed is another report' test "$(cmp -s one/results.json other/results.json; echo $?)" -eq 1
easiest=$(grep -m 1 '"right"' one/results.json)
check 'the easiest cell is right' test "${easiest//[^0-9]/}" -eq 1
"$report" --false-locks 4 >out.txt 2>err.txt
check 'a campaign of one clip without the target and one with it' test $? -eq 0
check 'the clips were watched whole' grep -q ' (120 frames, ' out.txt
check 'the target was locked' grep -q ' of 114 frames; never in 0 clips' out.txt
check 'the frames that count by themselves were seen' grep -Eq 'searched: [0-9.]+ % of [1-9]' out.txt
"$report" --only nothing >out.txt 2>err.txt
check 'a plane that is not there is refused' test $? -eq 2
"$report" --trials 0 >out.txt 2>err.txt
check 'no trials are refused' test $? -eq 2
ending

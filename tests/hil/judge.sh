# What judge() of a scenario may use, on the host, in the folder of its results. Sourced by run.

judge_scenario() (  # NAME RESULTS
  cd "$2"
  rm -f checks
  . "$here/scenarios/$1.sh"
  check "the play ended in order" "$(cat rc)" = 0
  judge
  ! grep -q '^FAILED' checks
)

# check TEXT VALUE COMPARISON LIMIT [UNIT]: one line of the table. Comparison: = != < <= > >= (numbers)
check() {
  local verdict
  verdict=$(awk -v v="$2" -v l="$4" -v c="$3" 'BEGIN {
    if (v == "") ok = 0
    else if (c == "=") ok = (v == l)
    else if (c == "!=") ok = (v != l)
    else if (c == "<") ok = (v + 0 < l + 0)
    else if (c == "<=") ok = (v + 0 <= l + 0)
    else if (c == ">") ok = (v + 0 > l + 0)
    else ok = (v + 0 >= l + 0)
    print ok ? "ok" : "FAILED" }')
  printf '%-6s %s: %s %s (%s %s)\n' "$verdict" "$1" "${2:-nothing}" "${5:-}" "$3" "$4" >>checks
}

at() { awk -v name="$*" '{t = $1; sub(/^[^ ]* /, ""); if ($0 == name) {print t; exit}}' marks; }

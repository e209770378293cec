# What judge() of a scenario may use, on the host, in the folder of its results. Sourced by run.
# Times are the guest's, in seconds; from one to another in milliseconds.

judge_scenario() (  # NAME RESULTS
  cd "$2"
  rm -f checks
  . "$here/scenarios/$1.sh"
  check "the play ended in order, code" "$(cat rc)" = 0
  judge
  ! grep -q '^FAILED' checks
)

# check TEXT VALUE COMPARISON LIMIT [UNIT]: one line of the table. = != compare text, < <= > >= numbers.
check() {
  local verdict
  verdict=$(awk -v v="$2" -v l="$4" -v c="$3" 'BEGIN {
    if (v == "") ok = 0
    else if (c == "=") ok = (v "" == l "")
    else if (c == "!=") ok = (v "" != l "")
    else if (c == "<") ok = (v + 0 < l + 0)
    else if (c == "<=") ok = (v + 0 <= l + 0)
    else if (c == ">") ok = (v + 0 > l + 0)
    else ok = (v + 0 >= l + 0)
    print ok ? "ok" : "FAILED" }')
  printf '%-6s %s: %s%s (%s %s)\n' "$verdict" "$1" "${2:-nothing}" "${5:+ $5}" "$3" "$4" >>checks
}

value() { sed -n "s/^$2=//p" "$1" | head -n1; }  # FILE KEY, of KEY=VALUE lines

# Time of a mark of the play.
at() { awk -v name="$*" '{t = $1; sub(/^[^ ]* /, ""); if ($0 == name) {print t; exit}}' marks; }
# Time of the first line of the journal from TIME on that holds REGEX.
logged() { awk -v from="$1" -v regex="$2" '$1 + 0 >= from + 0 && $0 ~ regex {print $1; exit}' journal; }
said() { grep -cE -- "$1" journal || true; }  # how many lines of the journal hold REGEX

ms() { # FROM TO
  [ -z "$1" ] || [ -z "$2" ] || awk -v a="$1" -v b="$2" 'BEGIN {printf "%.2f", (b - a) * 1000}'
}
plus() { awk -v a="$1" -v b="$2" 'BEGIN {printf "%.6f", a + b}'; }

# DroneCAN's esc.RawCommand (message 1030) on the bus, by the bytes alone, without Gannet's codec:
# "time 0" where all motors are told to stop, "time 1" where one is told to turn.
commands() {
  awk '$3 ~ /^..0406/ && length($3) == 8 {
    t = $1; gsub(/[()]/, "", t)
    tail = $NF; start = tail ~ /^[89A-F]/; end = tail ~ /^[4-7C-F]/
    first = 5; if (start) { moves = 0; if (!end) first = 7 }
    for (i = first; i < NF; i++) if ($i != "00") moves = 1
    if (end) print t, moves }' can
}
# From TIME on: the first command to stop / to turn, and how many to turn until a time.
stop_after() { commands | awk -v from="$1" '$1 >= from && !$2 {print $1; exit}'; }
turn_after() { commands | awk -v from="$1" '$1 >= from && $2 {print $1; exit}'; }
turns_between() { commands | awk -v from="$1" -v to="${2:-9e9}" '$1 >= from && $1 < to && $2 {n++} END {print n + 0}'; }
commands_between() { commands | awk -v from="$1" -v to="${2:-9e9}" '$1 >= from && $1 < to {n++} END {print n + 0}'; }
longest_gap() { # between commands, FROM TO
  commands | awk -v from="$1" -v to="$2" '$1 >= from && $1 < to {if (last && $1 - last > gap) gap = $1 - last; last = $1} END {printf "%.2f", gap * 1000}'
}

# What gannet-world judged itself: the scenario's CHECKS, by the kernel's stamps of the bus's frames.
world_checks() {
  local i=0
  while [ -n "$(value result "checks.$i.check")" ]; do
    check "world: $(value result "checks.$i.check"), found $(value result "checks.$i.found")" \
      "$(value result "checks.$i.passed")" = true
    i=$((i + 1))
  done
  check "checks of the world" "$i" ">" 0
}

# Of the drives' own reports (DroneCAN's esc.Status, message 1034) the greatest speed in rpm that any
# drive told between FROM and TO; by the bytes alone.
drives_rpm() {
  awk -v from="$1" -v to="${2:-9e9}" 'function byte(text, i) {
      return 16 * (index(digits, substr(text, 2 * i + 1, 1)) - 1) + index(digits, substr(text, 2 * i + 2, 1)) - 1 }
    BEGIN {digits = "0123456789ABCDEF"; most = 0}
    $3 ~ /^..040A/ && length($3) == 8 {
      t = $1; gsub(/[()]/, "", t)
      node = substr($3, 7); first = 5
      if ($NF ~ /^[89A-F]/) { data[node] = ""; first = 7 }
      for (i = first; i < NF; i++) data[node] = data[node] $i
      if ($NF ~ /^[4-7C-F]/ && length(data[node]) == 28) {
        rpm = byte(data[node], 10) + 256 * byte(data[node], 11) + 65536 * int(byte(data[node], 12) / 64)
        if (rpm >= 131072) rpm = 262144 - rpm
        if (t >= from && t < to && rpm > most) most = rpm
      }
    } END {print most}' can
}

# Of the time between FROM and TO, in percent, the share that the daemon was in STATE by its journal.
state_share() {  # STATE FROM TO
  awk -v state="$1" -v from="$2" -v to="$3" '
    function count(until) {
      if (now == state && until > from) sum += (until < to ? until : to) - (since > from ? since : from)
    }
    / gannetd\[.* → / && $1 + 0 < to + 0 {count($1); since = $1; for (i = 1; i < NF; i++) if ($i == "→") now = $(i + 1)}
    END {count(to); printf "%.0f", 100 * sum / (to - from)}' journal
}

# What tshark and python-can read in the recorded bus: into `decoded`; both must find every frame.
# Skipped, and said so, where they are not installed.
decode() {
  "$here/decode.sh" . >decoded
  local reader frames
  frames=$(sed -n 's/^frames recorded: //p' decoded)
  check "frames recorded" "$frames" ">" 100
  for reader in tshark python-can; do
    grep -q "^$reader: not installed" decoded || check "frames by $reader" "$(found "$reader: frames")" = "$frames"
  done
  grep -q '^tshark: CANopen' decoded || return 0
  check "tshark: all are CANopen" "$(found 'tshark: CANopen')" = "$frames"
  check "tshark: malformed, refused SDOs" "$(found 'tshark: malformed') $(found 'tshark: SDO refused')" = "0 0"
  check "tshark: objects set up by SDO" "$(found 'tshark: SDO writes')" ">" 20
  check "tshark: drives operational" "$(found 'tshark: drives operational')" = 8
}
found() { sed -n "s/^$1: //p" decoded; }

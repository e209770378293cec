# The bus: error-passive is told, bus-off and an interface that goes down stop everything, and nothing
# moves again without a person.
DURATION=13
EVENTS='
  4.5 s: bus passive
  5.5 s: bus up
  6.5 s: bus off
  8 s: bus up
'
CHECKS='"state faulted within 600 ms of bus off"'
play() {
  world_up
  daemon_up
  servoing
  until_true 8 faulted
  until_true 5 good_again
  sleep 0.5
  gannet reset >/dev/null
  servoing
  mark down
  ip link set vcan0 down
  until_true 2 state_is faulted
  mark faulted
  ip link set vcan0 up
  sleep 1.5
  mark "state $(state)"
}
faulted() { state_is faulted; }
good_again() { journalctl -u gannetd -o cat | grep -A99 'bus-off\|bus is off' | grep -q 'CAN bus is good'; }
judge() {
  local off
  off=$(awk '$3 ~ /^200000[4-7][0-9A-F]$/ {gsub(/[()]/, "", $1); print $1; exit}' can)
  check "told that the bus is passive" "$(said 'CAN bus is .*passive')" ">=" 1
  check "bus-off frame to the fault" "$(ms "$off" "$(logged "${off:-9e9}" '→ faulted')")" "<" 600 ms
  check "interface down to the fault" "$(ms "$(at down)" "$(logged "$(at down)" '→ faulted')")" "<" 600 ms
  check "commands to turn after that" "$(turns_between "$(logged "$(at down)" '→ faulted')")" = 0
  check "up again, still faulted" "$(at state faulted)" != ""
  check "restarts" "$(value unit NRestarts)" = 0
}

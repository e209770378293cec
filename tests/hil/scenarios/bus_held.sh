# The bus is up but takes nothing for a second, as when others hold it up, and its queue is a long one:
# no more commands wait than one servo cycle may send, so that hardly an old one reaches the motors when
# it flows again; the daemon has stopped everything meanwhile. The queue is the kernel's own (sch_plug),
# in front of a vcan that echoes as a controller's driver does.
LIMIT_S=60
play() {
  modprobe vcan echo=1
  modprobe sch_plug
  world_up
  daemon_up
  servoing
  sleep 0.3
  tc qdisc add dev vcan0 root plug limit 1000000
  mark held
  until_true 3 state_is faulted
  sleep 0.5
  figures held
  mark flows
  tc qdisc change dev vcan0 root plug release_indefinite
  sleep 0.5
  mark state "$(state)"
}
judge() {
  local flows
  flows=$(at flows)
  check "commands while it is held up" "$(commands_between "$(at held)" "$flows")" = 0
  check "held to the fault" "$(ms "$(at held)" "$(logged "$(at held)" '→ faulted')")" "<" 700 ms
  check "frames refused for want of room" "$(value top-held drops.can_send_no_room)" ">" 50
  # Eight ESCs: RawCommand, 3 frames; 17 at most in a cycle.
  check "old commands to turn that arrive" "$(turns_between "$flows")" "<=" 5
  check "flows to the last of them" "$(ms "$flows" "$(commands | awk -v from="$flows" '$1 >= from && $2 {t = $1} END {print t + 0 ? t : from}')")" "<" 30 ms
  check "flows to the first command to stop" "$(ms "$flows" "$(stop_after "$flows")")" "<" 30 ms
  check "still faulted" "$(at state faulted)" != ""
  check "restarts" "$(value unit NRestarts)" = 0
}

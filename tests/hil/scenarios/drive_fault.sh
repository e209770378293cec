# A drive reports a fault: all are stopped, the fault is latched.
EVENTS='
  5 s: fault drive 3
'
CHECKS='"permit none within 100 ms of fault drive 3", "state faulted within 150 ms of fault drive 3", "state is faulted at 8.5 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "the journal names the motor" "$(said 'motor 3 reports a fault')" ">=" 1
  check "restarts" "$(value unit NRestarts)" = 0
}

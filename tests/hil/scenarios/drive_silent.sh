# A drive stops answering: all are stopped, the fault is latched.
EVENTS='
  5 s: silence drive 3
'
CHECKS='"permit none within 600 ms of silence drive 3", "state faulted within 700 ms of silence drive 3", "state is faulted at 8.5 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "the journal names the motor" "$(said 'motor 3 is not heard')" ">=" 1
  check "restarts" "$(value unit NRestarts)" = 0
}

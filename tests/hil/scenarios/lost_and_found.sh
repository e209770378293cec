# Something swims between: the ROV holds, and goes on when it sees the target again.
EVENTS='
  5 s: occlude crab
  6.5 s: uncover crab
'
CHECKS='"state holding within 1000 ms of occlude crab", "state servoing within 2500 ms of uncover crab"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "restarts" "$(value unit NRestarts)" = 0
}

# Three of ten pairs never arrive; the ROV goes on.
EVENTS='
  0 s: drop 0.3
'
CHECKS='"found_share > 0.5 after 5 s", "state is servoing at 8.5 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "commands to turn" "$(turns_between "$(at servoing)")" ">" 100
}

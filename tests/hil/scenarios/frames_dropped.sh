# Three of ten pairs never arrive; the ROV goes on.
EVENTS='
[[event]]
at_s = 0
do = "drop 0.3"
'
play() {
  world_up
  daemon_up
  servoing
  sleep 3
  mark "state $(state)"
}
judge() {
  check "servoes after 3 s" "$(at state servoing)" != ""
  check "pairs that came" "$(value top-end drops.frames)" ">" 10
  check "moves" "$(turns_between "$(at servoing)")" ">" 100 commands
}

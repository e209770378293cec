# Something swims between: the ROV holds, and goes on when it sees the target again.
EVENTS='
[[event]]
at_s = 6
do = "occlude crab"
[[event]]
at_s = 7.5
do = "uncover crab"
'
play() {
  world_up
  daemon_up
  servoing
  wait $WORLD_PID || true
}
judge() {
  local lost back
  lost=$(logged "$(at servoing)" 'track (coasting|lost)')
  back=$(logged "${lost:-9e9}" 'holding → servoing')
  check "loses the target" "$lost" != ""
  check "lost to holding, full_age_s 0.3" "$(ms "$lost" "$(logged "${lost:-9e9}" 'servoing → holding')")" "<" 500 ms
  check "servoes again" "$back" != ""
  check "restarts" "$(value unit NRestarts)" = 0
}

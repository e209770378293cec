# The emergency stop is pressed and released while the ROV moves: at once nothing moves, release alone
# changes nothing, a person's reset and arming bring it back.
play() {
  world_up
  daemon_up
  servoing
  sleep 0.5
  press
  sleep 0.7
  mark "state $(state)"
  release
  sleep 0.7
  mark "still $(state)"
  mark reset
  gannet reset >/dev/null
  mark "then $(state)"
  servoing
  sleep 0.3
}
judge() {
  check "moves before" "$(turns_between "$(at servoing)" "$(at press)")" ">" 10 commands
  check "edge to the first command to stop, period 10 ms" "$(ms "$(at press)" "$(stop_after "$(at press)")")" "<=" 10.5 ms
  check "commands to turn from then to the reset" "$(turns_between "$(stop_after "$(at press)")" "$(at reset)")" = 0
  check "stopped when pressed" "$(at state stopped)" != ""
  check "stopped after the release too" "$(at still stopped)" != ""
  check "standby after the reset" "$(at then standby)" != ""
  check "moves again after arming" "$(turn_after "$(at reset)")" != ""
}

# The main job from a cold start of the service: it comes up in standby, is armed, comes to the target
# and holds it. The order of priorities: the servo loop wakes on time although vision computes.
play() {
  world_up
  daemon_up
  mark "state $(state)"
  servoing
  sleep 4
  figures servoing
  wait $WORLD_PID
}
judge() {
  check "systemctl start returns" "$(ms "$(at start)" "$(at started)")" "<" 3000 ms
  check "standby after the start" "$(at state standby)" != ""
  check "no command to turn before arming" "$(turns_between 0 "$(at arm)")" = 0
  check "start to servoing" "$(ms "$(at start)" "$(at servoing)")" "<" 6000 ms
  check "the world's own checks" "$(value result passed)" = true
  check "servo wake-up, longest" "$(value top-servoing latencies.servo_jitter.max_us)" "<" 100 us
}

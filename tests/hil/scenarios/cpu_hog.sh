# Two loops at normal priority beside the daemon: the servo loop's wake-ups do not notice.
play() {
  world_up
  daemon_up
  servoing
  for i in 1 2; do sh -c 'while :; do :; done' & done
  mark hog
  sleep 2
  figures hog
  mark over
}
judge() {
  check "servo wake-up, longest" "$(value top-hog latencies.servo_jitter.max_us)" "<" 100 us
  check "overruns" "$(value top-hog drops.servo_overruns)" = 0
  check "commands in 2 s at 100 Hz" "$(commands_between "$(at hog)" "$(plus "$(at hog)" 2)")" ">=" 199
}

# Pictures that stand still, stamps that run backwards, frames that end too early: each is counted,
# none is used, and the ROV servoes again afterwards.
DURATION=14
EVENTS='
  4.5 s: freeze camera
  5.7 s: mend camera
  7.5 s: backward stamps
  8.7 s: mend camera
  10.5 s: short frames
  11.7 s: mend camera
'
CHECKS='"state holding within 1000 ms of freeze camera", "state holding within 1000 ms of backward stamps", "state holding within 1000 ms of short frames", "state is servoing at 13.8 s", "counted frozen > 2", "counted backward > 2", "counted short > 2"'
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

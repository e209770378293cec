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
CHECKS='"state holding within 1000 ms of freeze camera", "state holding within 1000 ms of backward stamps", "state holding within 1000 ms of short frames", "state is servoing at 13.8 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "frozen images counted" "$(value top-end cameras.frozen)" ">=" 3
  check "backward stamps counted" "$(value top-end cameras.backward)" ">=" 3
  check "short images counted" "$(value top-end cameras.short)" ">=" 3
  check "restarts" "$(value unit NRestarts)" = 0
}

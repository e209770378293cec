# One camera delivers 15 ms later than the other, with true stamps: pairs still belong together.
EVENTS='
  0 s: late right 15
'
CHECKS='"found_share > 0.9 after 5 s", "rms_mm < 20 after 7 s", "state is servoing at 8.5 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "images without a twin" "$(value top-end cameras.unpaired)" "<=" 1
}

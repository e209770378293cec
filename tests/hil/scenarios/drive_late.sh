# What a drive says comes 100 ms late, within its time: nothing stops; 800 ms late: the fault is told.
EVENTS='
  4 s: late drive 3 100
  6 s: late drive 3 800
'
CHECKS='"state is servoing at 5.9 s", "state faulted within 900 ms of late drive 3 800"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
}

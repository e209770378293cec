# The vision thread stops for good, as if it hung. The ROV holds, the watchdog is not fed, systemd ends
# the daemon and starts it anew, into standby; nothing moves until a person arms it.
DURATION=30
play() {
  world_up
  daemon_up
  servoing
  pid=$(systemctl show -P MainPID gannetd)
  for task in /proc/$pid/task/*; do
    case $(cat $task/comm) in gannet-vision) thread=${task##*/} ;; esac
  done
  ./hold "$thread" hung >>$OUT/marks &
  until_true 10 restarted
  until_true 5 state_is standby
  sleep 0.5
  mark "state $(state)"
}
restarted() { [ "$(systemctl show -P NRestarts gannetd)" -ge 1 ]; }
judge() {
  local killed
  killed=$(logged "$(at hung)" 'Watchdog timeout')
  check "hung to holding, full_age_s 0.3" "$(ms "$(at hung)" "$(logged "$(at hung)" 'servoing → holding')")" "<" 600 ms
  check "hung to the watchdog, WatchdogSec 2 s" "$(ms "$(at hung)" "$killed")" "<" 3500 ms
  check "the journal names the loop" "$(said 'loops stand still: .*vision')" ">=" 1
  check "watchdog to standby" "$(ms "$killed" "$(logged "${killed:-9e9}" 'starting → standby')")" "<" 2500 ms
  # systemd says so some milliseconds before it kills: a servo cycle may still fall between.
  check "commands to turn from 20 ms after the watchdog" "$(turns_between "$(plus "${killed:-9e9}" 0.02)")" = 0
  check "restarts" "$(value unit NRestarts)" = 1
  check "standby at the end" "$(at state standby)" != ""
}

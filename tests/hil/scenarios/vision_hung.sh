# The vision thread gets no processor: put at idle priority beside a loop at normal one. The watchdog
# is not fed, systemd ends the daemon and starts it anew.
play() {
  world_up
  daemon_up
  servoing
  pid=$(systemctl show -P MainPID gannetd)
  for task in /proc/$pid/task/*; do
    case $(cat $task/comm) in gannet-vision*) thread=${task##*/} ;; esac
  done
  sh -c 'while :; do :; done' & HOG=$!
  mark hung
  chrt --idle -p 0 "$thread"
  until_true 10 restarted
  mark restarted
  kill $HOG
  sleep 5
  mark "state $(state)"
}
restarted() { [ "$(systemctl show -P NRestarts gannetd)" -ge 1 ]; }
judge() {
  local holds
  holds=$(logged "$(at hung)" 'servoing → holding')
  check "hung to holding, full_age_s 0.3" "$(ms "$(at hung)" "$holds")" "<" 600 ms
  check "hung to the watchdog, WatchdogSec 2 s" "$(ms "$(at hung)" "$(logged "$(at hung)" 'Watchdog timeout')")" "<" 3500 ms
  check "the journal names the loop" "$(said 'loops stand still: .*vision')" ">=" 1
  check "commands to turn after the watchdog" "$(turns_between "$(logged "$(at hung)" 'Watchdog timeout')")" = 0
  check "watchdog to standby" "$(ms "$(logged "$(at hung)" 'Watchdog timeout')" "$(logged "$(at restarted)" 'starting → standby')")" "<" 4000 ms
}

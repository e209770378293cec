# The daemon is killed. Nobody commands the drives any more, so their own guard stops them; systemd
# brings the daemon back, into standby, and nothing moves until a person arms it.
play() {
  world_up
  daemon_up
  servoing
  sleep 0.5
  pid=$(systemctl show -P MainPID gannetd)
  mark kill
  kill -9 "$pid"
  sleep 3
  mark "state $(state)"
}
judge() {
  local last
  last=$(commands | awk -v k="$(at kill)" '$1 < k + 0.5 {t = $1} END {print t}')
  check "kill to the last command" "$(ms "$(at kill)" "$last")" "<" 10 ms
  check "kill to standby" "$(ms "$(at kill)" "$(logged "$(at kill)" 'starting → standby')")" "<" 2000 ms
  check "restarts" "$(value unit NRestarts)" = 1
  check "commands to turn after it" "$(turns_between "$(plus "$(at kill)" 0.01)")" = 0
  check "standby three seconds later" "$(at state standby)" != ""
  check "fastest drive before the kill, by its own report" "$(drives_rpm "$(plus "$(at kill)" -0.3)" "$(at kill)")" ">" 50 rpm
  check "fastest drive from 1.5 s after the kill on, guard 0.5 s, run-down 0.2 s" "$(drives_rpm "$(plus "$(at kill)" 1.5)")" "<" 30 rpm
}

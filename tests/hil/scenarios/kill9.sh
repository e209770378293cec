# The daemon is killed. Nobody commands the drives any more, so their own guard stops them; systemd
# brings the daemon back, into standby, and nothing moves until a person arms it.
play() {
  world_up
  daemon_up
  servoing
  sleep 0.5
  mark kill
  kill -9 "$(systemctl show -P MainPID gannetd)"
  until_true 4 state_is standby
  mark standby
  sleep 1
  mark "state $(state)"
}
judge() {
  local last
  last=$(commands | awk -v k="$(at kill)" '$1 < k + 0.05 {t = $1} END {print t}')
  check "kill to the last command" "$(ms "$(at kill)" "$last")" "<" 10 ms
  check "kill to standby" "$(ms "$(at kill)" "$(at standby)")" "<" 2000 ms
  check "restarts" "$(value unit NRestarts)" = 1
  check "commands to turn after it" "$(turns_between "$(plus "$(at kill)" 0.05)")" = 0
  check "standby a second later" "$(at state standby)" != ""
  check "fastest drive before the kill, by its own report" "$(drives_rpm "$(plus "$(at kill)" -0.3)" "$(at kill)")" ">" 50 rpm
  check "fastest drive from 0.8 s after the kill on" "$(drives_rpm "$(plus "$(at kill)" 0.8)")" "<" 10 rpm
}

# A second daemon is started by mistake: it is refused and says why; the first goes on.
play() {
  world_up
  daemon_up
  servoing
  mark second
  code=0
  setpriv --reuid gannet --regid gannet --init-groups gannetd -c /etc/gannet/gannet.toml >$OUT/second 2>&1 || code=$?
  mark refused
  note "code=$code"
  sleep 0.5
  mark "state $(state)"
}
judge() {
  check "refused with" "$(value notes code)" = 3
  check "start to refusal" "$(ms "$(at second)" "$(at refused)")" "<" 2000 ms
  check "in words" "$(grep -ciE 'in use|already|another' second)" ">=" 1
  check "the first still servoes" "$(at state servoing)" != ""
  check "commands of the first meanwhile, each 10 ms: longest gap" "$(longest_gap "$(at second)" "$(at refused)")" "<" 11 ms
}

# A config with mistakes: the unit fails, the journal says why, and it is not tried again.
play() {
  printf 'format = 1\nrig = "nowhere.toml"\n[servo]\nposition_gian = 2\n[realtime]\nservo_rate_hz = 5000\n' >/etc/gannet/gannet.toml
  mark start
  systemctl start gannetd && note "it started" || true
  mark failed
  sleep 2
}
judge() {
  check "start to failed" "$(ms "$(at start)" "$(at failed)")" "<" 2000 ms
  check "the unit has failed" "$(value unit ActiveState)" = failed
  check "tried again" "$(value unit NRestarts)" = 0 times
  check "each mistake with its place in the journal" "$(said 'gannet.toml:(4|6): ')" = 2
  check "the nearest word" "$(said 'position_gain')" ">=" 1
}

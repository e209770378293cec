# Servo drives by CiA 402 over CANopen on SocketCAN: set up, armed, station held. What tshark and
# python-can read in the recorded bus is beside, in `decoded`.
DRIVES=cia402
CHECKS='"rms_mm < 15 after 7 s", "found_share > 0.9 after 4 s"'
play() {
  world_up
  daemon_up
  servoing
  world_ends
}
judge() {
  world_checks
  check "start to standby" "$(ms "$(at start)" "$(at standby)")" "<" 4000 ms
  check "restarts" "$(value unit NRestarts)" = 0
  decode
}

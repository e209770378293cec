# The kernel's own interfaces work in the guest: CAN frames, GPIO lines, cameras, real-time priorities.
play() {
  uname -v
  systemctl is-system-running || true
  ip link add vcan0 type vcan
  ip link set vcan0 up
  candump -t a vcan0 >$OUT/can & CANDUMP=$!
  sleep 0.1
  mark send
  cansend vcan0 123#1122
  sleep 0.1
  modprobe v4l2loopback devices=2 video_nr=10,11
  ls -l /dev/video*
  cyclictest -q -m -p80 -i1000 -l1000
}
judge() {
  check "frames seen" "$(wc -l <can)" = 1
  check "PREEMPT_RT" "$(grep -c PREEMPT_RT log)" = 1
}

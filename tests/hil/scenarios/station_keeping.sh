# The main job from a cold start of the service: it comes up in standby, is armed, comes to the target
# and holds it. The servo loop wakes on time although vision computes: priorities as configured.
CHECKS='"rms_mm < 15 after 7 s", "found_share > 0.9 after 4 s"'
play() {
  world_up
  daemon_up
  servoing
  sleep 3
  figures servoing
  for task in "/proc/$(systemctl show -P MainPID gannetd)"/task/*; do
    echo "$(cat "$task/comm") $(chrt -p "${task##*/}" | awk -F': ' '{printf "%s ", $2}')"
  done >$OUT/threads
  world_ends
  systemd-analyze security gannetd --no-pager >$OUT/security
  dpkg-query -W -f '${Package} ${Version}: ${Installed-Size} KiB, needs ${Depends}\n' 'gannet*' >$OUT/packages
}
judge() {
  check "systemctl start returns" "$(ms "$(at start)" "$(at started)")" "<" 3000 ms
  check "start to standby" "$(ms "$(at start)" "$(at standby)")" "<" 4000 ms
  check "commands to turn before arming" "$(turns_between 0 "$(at arm)")" = 0
  check "start to servoing" "$(ms "$(at start)" "$(at servoing)")" "<" 6000 ms
  world_checks
  check "servo wake-up, longest" "$(value top-servoing latencies.servo_jitter.max_us)" "<" 100 us
  check "servo, capture, vision: priorities" "$(for t in servo capture vision; do
    awk -v t="gannet-$t" '$1 == t {printf "%s ", $3}' threads; done)" = "80 70 50 "
  check "systemd-analyze security, exposure" "$(sed -n 's/.*exposure level for gannetd.service: \([0-9.]*\).*/\1/p' security)" "<=" 1.5
  check "installed size of gannet" "$(sed -n 's/^gannet .*: \([0-9]*\) KiB.*/\1/p' packages)" "<" 20000 KiB
}

# What play() of a scenario may use, in the guest. Sourced by start. Times are CLOCK_REALTIME, which
# candump and the journal use too.
OUT=/hil/out
WORLD=/etc/gannet/world

mark() { date "+%s.%N $*" >>$OUT/marks; }
note() { echo "$*" >>$OUT/notes; }
since_boot() { cut -d' ' -f1 /proc/uptime; }

# until_true SECONDS COMMAND …: asks every 50 ms; false when it never held.
until_true() {
  tries=$(($1 * 20))
  shift
  while ! "$@"; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || return 1
    sleep 0.05
  done
}

# ---- devices --------------------------------------------------------------------------------------
can_up() {
  ip link add vcan0 type vcan
  ip link set vcan0 up
  candump -t a vcan0,0:0,#FFFFFFFF >$OUT/can &  # with error frames
  CANDUMP=$!
}

# The lines of a chip "rov"; LINES becomes its folder, with sim_gpio0 (e-stop) and so on. The e-stop
# is a contact that closes to high when pressed; its pull is the switch.
lines_up() {
  modprobe -a configfs gpio-sim
  mountpoint -q /sys/kernel/config || mount -t configfs none /sys/kernel/config
  chip=/sys/kernel/config/gpio-sim/rov
  mkdir -p $chip/bank0
  echo 8 >$chip/bank0/num_lines
  echo rov >$chip/bank0/label
  number=0
  for line in estop estop_second release light; do  # in the world's order
    mkdir $chip/bank0/line$number
    echo $line >$chip/bank0/line$number/name
    number=$((number + 1))
  done
  echo 1 >$chip/live
  LINES=/sys/devices/platform/$(cat $chip/dev_name)/$(cat $chip/bank0/chip_name)
  echo pull-down >"$LINES/sim_gpio0/pull"
  udevadm settle
}
press() { ./poke "$LINES/sim_gpio0/pull" pull-up press >>$OUT/marks; }
release() { ./poke "$LINES/sim_gpio0/pull" pull-down release >>$OUT/marks; }

cameras_up() {
  modprobe v4l2loopback devices=2 video_nr=10,11 card_label=left,right max_buffers=8
  udevadm settle
}

# ---- world and daemon -----------------------------------------------------------------------------
# The world of scenario.toml behind the kernel's interfaces, and the daemon's config that fits it.
world_up() {
  can_up
  lines_up
  cameras_up
  mkdir -p $WORLD
  gannet-world /hil/scenario.toml --live --attach $WORLD --cameras v4l2:/dev/video10,/dev/video11 \
    --can socketcan:vcan0 --lines "gpio-sim:$LINES" --control /run/gannet/control \
    --seed "$SEED" --record $OUT/world "$@" \
    >$OUT/world.log 2>&1 &
  WORLD_PID=$!
  until_true 20 test -s $WORLD/gannetd.toml
  sleep 0.2
  configure $WORLD/gannetd.toml
}
configure() {  # FILE
  cp "$1" /etc/gannet/gannet.toml
  [ ! -d "$1.d" ] || cp "$1".d/* /etc/gannet/gannet.toml.d
  chgrp -R gannet /etc/gannet
  chmod -R g+rX /etc/gannet
}
daemon_up() { mark start; systemctl start gannetd; mark started; }

state() { gannet status --json 2>/dev/null | jq -r .state; }
state_is() { [ "$(state)" = "$1" ]; }
world_ends() { wait $WORLD_PID || note "world=$?"; }
servoing() {  # choose the target, arm as soon as it may be, and wait until it servoes
  until_true 8 state_is standby
  mark standby
  gannet target model crab >/dev/null
  mark arm
  until_true 8 quietly gannet arm
  until_true 8 state_is servoing
  mark servoing
}
quietly() { "$@" >/dev/null 2>&1; }

# What the daemon says of itself, as KEY=VALUE lines for the judge: status-WHEN, top-WHEN.
flatten() { jq -r 'paths(scalars) as $p | ($p | map(tostring) | join(".")) + "=" + (getpath($p) | tostring)'; }
figures() {  # WHEN
  mark "figures $1"
  gannet status --json 2>/dev/null | flatten >"$OUT/status-$1"
  gannet top --once --json 2>/dev/null | flatten >"$OUT/top-$1"
}

# ---- the end ----------------------------------------------------------------------------------------
finish() {  # CODE
  set +e
  [ -z "$LIMIT" ] || kill "$LIMIT"  # a shell may last
  echo "$1" >$OUT/rc
  figures end
  [ ! -e $OUT/world/result.json ] || flatten <$OUT/world/result.json >$OUT/result
  systemctl show gannetd >$OUT/unit
  kill $CANDUMP $WORLD_PID 2>/dev/null
  journalctl -o short-unix --no-hostname >$OUT/journal 2>/dev/null
  dmesg >$OUT/dmesg
  if [ -n "$SHELL_WANTED" ]; then
    echo "hil: the scenario is over, code $1; results are in $OUT. exit ends the guest." >/dev/console
    setsid sh -c 'exec sh -i <>/dev/ttyS0 >&0 2>&1'
  fi
  cd /
  sync
  mount -o remount,ro /hil
  echo o >/proc/sysrq-trigger
  sleep 10
}

# What play() of a scenario may use, in the guest. Sourced by start.
OUT=/hil/out
LINES_DIR=

mark() { date "+%s.%N $*" >>$OUT/marks; }  # CLOCK_REALTIME, which candump and the journal use too
note() { echo "$*" >>$OUT/notes; }

finish() {  # CODE
  set +e
  echo "$1" >$OUT/rc
  [ -z "$CANDUMP" ] || kill "$CANDUMP" 2>/dev/null
  journalctl -o short-unix --no-hostname >$OUT/journal 2>/dev/null
  dmesg >$OUT/dmesg
  if [ -n "$SHELL_WANTED" ]; then
    echo "hil: the scenario is over, code $1; results are in $OUT. exit ends the guest." >/dev/console
    setsid sh -c 'exec sh -i <>/dev/ttyS0 >&0 2>&1'
  fi
  cd /
  sync
  umount /hil
  echo o >/proc/sysrq-trigger
  sleep 10
}

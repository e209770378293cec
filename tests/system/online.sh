#!/bin/bash
# `gannet` against a real gannetd that replays a recording without motors: every online subcommand,
# as text and as JSON. Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
programs gannet gannetd
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null; rm -rf "$work"' EXIT

mkdir -p frames/left frames/right
cp "$pictures/target.png" frames/left/1.png
cp "$pictures/target.png" frames/right/1.png
small_rig >rig.toml
cat >gannet.toml <<'TOML'
rig = "rig.toml"
models = ["disc.gannet"]
camera.kind = "replay"
camera.replay.directory = "frames"
camera.replay.loop = true
control.socket = "control"
realtime.lock_memory = false
track.evaluations = 200
[[mission.visit]]
model = "disc"
goal_z_m = 0.6
TOML
build_disc >/dev/null || exit 1
"$gannetd" -c gannet.toml >daemon.log 2>&1 &
daemon=$!
for _ in $(seq 100); do
  [ -S control ] && break
  kill -0 "$daemon" 2>/dev/null || { cat daemon.log; echo '0 passed, 1 failed, 0 skipped'; exit 1; }
  sleep 0.1
done

# says NAME EXIT PATTERN WORDS…: exit code, and a line of either stream that matches.
says() {
  local name=$1 wanted=$2 pattern=$3 code
  shift 3
  "$gannet" "$@" --socket control >out.txt 2>&1
  code=$?
  [ -s out.txt ] || echo NOTHING >out.txt
  if [ $code -eq "$wanted" ] && grep -Eq -- "$pattern" out.txt; then pass; else
    fail "$name" "exit $code" "$(head -c 600 out.txt)"
  fi
}

says 'status tells the state' 0 '^state +(standby|starting)' status
says 'status as JSON' 0 '^\{"state":"' status --json
says 'a model can be chosen' 0 '"model":"disc"' target model disc
says 'a mistyped model is refused with the nearest' 2 'did you mean "disc"' target model dics
says 'a rectangle can be chosen' 0 '"kind":"roi"' target roi 50,30,60,60
says 'a rectangle outside is refused' 2 'inside the image' target roi 150,30,60,60
says 'nothing can be chosen' 0 '"kind":"none"' target none
says 'a goal can be set' 0 '"goal_mm":\[0.0,-20.5,600.0\]' goal 0,-20.5,600
says 'a goal behind the cameras is refused' 2 'z must be positive' goal 0,0,-600
says 'the goal is in the status' 0 '0, -20, 600 mm|0, -21, 600 mm' status
says 'arming without a vehicle is refused' 1 'refused' arm
says 'a refusal as JSON has its code' 1 '^\{"error":\{.*"code":"refused"' arm --json
says 'config show tells origins' 0 '^track.evaluations = 200 +# .*gannet.toml:8$' config show
says 'config show as JSON' 0 '"values":\[\{"key":"rig"' config show --json
says 'top shows stages' 0 '^frame_to_pose' top
says 'top as JSON' 0 '"loops":\[' top --json
says 'a mission is listed' 0 '^ +1 +disc +0, 0, 600 ' mission list
says 'a mission that is not armed is refused' 1 'not armed' mission start
says 'a mission that is not armed, as JSON' 1 '"reason":"not_armed"' mission start --json
says 'a mission that never ran is idle' 0 '^idle, 1 visits' mission status
says 'stopping no mission changes nothing' 0 '"state":"idle"' mission stop --json
says 'a mission has four words' 2 'list' mission go
says 'events tell the goal' 0 '600' events
says 'events after the last are none' 0 NOTHING events --since 1000000
says 'manual without a vehicle is refused' 1 'refused' manual 0.1,0,0
says 'stop is taken' 0 'permit none' stop
says 'a stop is left by reset alone' 1 'refused' arm

kill "$daemon"
wait "$daemon"
code=$?
daemon=
tail -5 daemon.log >out.txt
check 'gannetd stops in order' [ $code -eq 0 ]
says 'after it has stopped nobody serves' 2 'nobody serves' status

ending

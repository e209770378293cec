#!/bin/bash
# `gannet` against a real gannetd that replays a recording without motors: every online subcommand,
# as text and as JSON. Last line: "N passed, N failed, N skipped".
set -u
build=${GANNET_BUILD:-build/release}
for program in gannet gannetd; do
  [ -x "$build/bin/$program" ] || { echo "no $build/bin/$program: run make first"; exit 77; }
done
gannet=$(realpath "$build/bin/gannet")
gannetd=$(realpath "$build/bin/gannetd")
pictures=$(realpath "$(dirname "$0")/pictures")
work=$(mktemp -d)
daemon=
trap '[ -z "$daemon" ] || kill "$daemon" 2>/dev/null; rm -rf "$work"' EXIT
cd "$work" || exit 1
passed=0
failed=0

mkdir -p frames/left frames/right
cp "$pictures/target.png" frames/left/1.png
cp "$pictures/target.png" frames/right/1.png
cat >rig.toml <<'TOML'
[left]
width = 160
height = 120
fx = 160.0
fy = 160.0
cx = 79.5
cy = 59.5
[right]
width = 160
height = 120
fx = 160.0
fy = 160.0
cx = 79.5
cy = 59.5
[right_from_left]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
translation_m = [-0.001, 0, 0]
TOML
cat >gannet.toml <<'TOML'
rig = "rig.toml"
models = ["disc.gannet"]
camera.kind = "replay"
camera.replay.directory = "frames"
camera.replay.loop = true
control.socket = "control"
realtime.lock_memory = false
track.evaluations = 200
TOML
"$gannet" model build --rig rig.toml --target "$pictures/target.png" --mask "$pictures/mask.png" \
  --distance-mm 400 --name disc -o disc.gannet >/dev/null || exit 1
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
  if [ $code -eq "$wanted" ] && grep -Eq -- "$pattern" out.txt; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    printf 'FAILED %s: exit %d\n' "$name" $code
    head -c 600 out.txt
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
says 'events tell the goal' 0 '600' events
says 'events after the last are none' 0 NOTHING events --since 1000000
says 'manual without a vehicle is refused' 1 'refused' manual 0.1,0,0
says 'stop is taken' 0 'permit none' stop
says 'a stop is left by reset alone' 1 'refused' arm

kill "$daemon"
wait "$daemon"
code=$?
daemon=
if [ $code -eq 0 ]; then passed=$((passed + 1)); else
  failed=$((failed + 1))
  echo "FAILED gannetd stops in order: exit $code"
  tail -5 daemon.log
fi
says 'after it has stopped nobody serves' 2 'nobody serves' status

echo "$passed passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]

#!/bin/bash
# Bad input to the real `gannet`: each case gets exit 2, one clear line on standard error that says
# what, where and what is wanted, and leaves what was there before as it was.
# Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
programs gannet

# refuses NAME PATTERN COMMAND…: exit 2, and one line on standard error that matches the pattern.
refuses() {
  local name=$1 pattern=$2 code lines
  shift 2
  "$@" >out.txt 2>err.txt
  code=$?
  lines=$(wc -l <err.txt)
  if [ $code -ne 2 ] || [ "$lines" -ne 1 ] || ! grep -Eq -- "$pattern" err.txt; then
    fail "$name" "exit $code, $lines lines" "$(head -c 500 err.txt)" "wanted: $pattern"
  elif [ -s out.txt ] && ! grep -q '"error"' out.txt; then
    fail "$name" "standard output: $(head -c 300 out.txt)"
  else
    pass
  fi
}

# 160x120 pixels: a disc of coloured squares on a ground of darker ones, the ground alone, the disc's
# mask, all black, all white; and 80x60 pixels of the ground.
cp "$pictures"/*.png .
head -c $(($(wc -c <target.png) / 2)) target.png >cut.png
: >empty_file.png
echo 'this is no picture' >text.png

rig() { small_rig "${3:-[-0.12, 0, 0]}" "${1:-160.0}" "${2:-[1, 0, 0, 0, 1, 0, 0, 0, 1]}"; }
rig >rig.toml
rig 0 >focal.toml
rig 160.0 '[1, 0, 0, 0, 1, 0, 0, 0, -1]' >mirror.toml
rig 160.0 '[1, 0, 0, 0, 1, 0, 0, 0, 1]' '[0, 0, 0]' >baseline.toml
{ rig; echo 'focus = 3'; } >unknown.toml
{ rig; echo '[port]'; echo 'thickness_m = 0.01'; } >port.toml
echo 'fx = = 3' >broken.toml

build=("$gannet" model build --rig rig.toml --name crab)
"${build[@]}" --target target.png --mask mask.png -o crab.gannet >/dev/null 2>err.txt ||
  fail "a good model is built" "$(cat err.txt)"
cp crab.gannet before.gannet

# ---- model build
out=(-o crab.gannet)
refuses 'build: a missing photo' 'no_such.png' "${build[@]}" --target no_such.png --mask mask.png "${out[@]}"
refuses 'build: a truncated PNG' 'cut.png.*byte' "${build[@]}" --target cut.png --mask mask.png "${out[@]}"
refuses 'build: an empty file' 'empty_file.png' "${build[@]}" --target empty_file.png --mask mask.png "${out[@]}"
refuses 'build: no picture' 'text.png' "${build[@]}" --target text.png --mask mask.png "${out[@]}"
refuses 'build: a photo of another size' 'small.png: is 80x60 pixels, but the left camera of the rig has 160x120' \
  "${build[@]}" --target small.png --mask mask.png "${out[@]}"
refuses 'build: a mask of another size' 'target.png with small.png: the mask is 80x60' "${build[@]}" --target target.png --mask small.png "${out[@]}"
refuses 'build: a background of another size' 'small.png: is 80x60' "${build[@]}" --target target.png --background small.png "${out[@]}"
refuses 'build: a background that equals the photo' 'background photo equals the target photo' \
  "${build[@]}" --target target.png --background target.png "${out[@]}"
refuses 'build: an empty silhouette' 'target.png with black.png: .*silhouette is empty' "${build[@]}" --target target.png --mask black.png "${out[@]}"
refuses 'build: a mask of everything' 'target.png with white.png: the mask covers the whole photo' "${build[@]}" --target target.png --mask white.png "${out[@]}"
refuses 'build: neither background nor mask' '--background or --mask is missing' "${build[@]}" --target target.png "${out[@]}"
for distance in 0 -400 nan 1e9 zero; do
  refuses "build: distance $distance" '--distance-mm: ' \
    "${build[@]}" --target target.png --mask mask.png --distance-mm=$distance "${out[@]}"
done
refuses 'build: an empty name' '--name' "$gannet" model build --rig rig.toml --name= --target target.png --mask mask.png "${out[@]}"
refuses 'build: an unknown option' 'unknown option --backgruond \(did you mean --background\?\)' \
  "${build[@]}" --target target.png --backgruond empty.png "${out[@]}"
refuses 'build: a folder that is not there' 'no/such' "${build[@]}" --target target.png --mask mask.png -o no/such/crab.gannet
cmp -s crab.gannet before.gannet && pass || fail 'the old model is as it was'

# ---- rigs
locate=("$gannet" locate --left target.png --right empty.png --model crab.gannet)
refuses 'rig: missing' 'no_rig.toml: cannot be opened' "${locate[@]}" --rig no_rig.toml
refuses 'rig: zero focal length' 'focal.toml:4: left.fx: 0 px is outside' "${locate[@]}" --rig focal.toml
refuses 'rig: a mirror' 'mirror.toml:16: right_from_left.rotation: is not a rotation' "${locate[@]}" --rig mirror.toml
refuses 'rig: no baseline' 'baseline.toml:17: right_from_left.translation_m: ' "${locate[@]}" --rig baseline.toml
refuses 'rig: an unknown key' 'unknown.toml:18: right_from_left.focus: unknown key' "${locate[@]}" --rig unknown.toml
refuses 'rig: one port for both cameras' 'port.toml:18: port: each camera has its own: write \[left.port\] and \[right.port\]' "${locate[@]}" --rig port.toml
refuses 'rig: no TOML' 'broken.toml:1: not valid TOML' "${locate[@]}" --rig broken.toml
refuses 'rig: a picture' 'target.png:1: ' "${locate[@]}" --rig target.png

# ---- locate
pair=("$gannet" locate --rig rig.toml --left target.png)
refuses 'locate: a missing right image' 'no_right.png' "${pair[@]}" --right no_right.png --model crab.gannet
refuses 'locate: no right image given' '--right is missing' "${pair[@]}" --model crab.gannet
refuses 'locate: a right image of another size' 'small.png: is 80x60 pixels, but the right camera' \
  "${pair[@]}" --right small.png --model crab.gannet
refuses 'locate: a truncated right image' 'cut.png.*byte' "${pair[@]}" --right cut.png --model crab.gannet
locate=("${pair[@]}" --right empty.png)
refuses 'locate: neither model nor rectangle' 'one of --model and --roi' "${locate[@]}"
refuses 'locate: both model and rectangle' 'one of --model and --roi' "${locate[@]}" --model crab.gannet --roi 1,2,30,30
refuses 'locate: a missing model' 'no.gannet' "${locate[@]}" --model no.gannet
refuses 'locate: a picture for a model' 'target.png: is not a gannet model' "${locate[@]}" --model target.png
head -c 2000 crab.gannet >cut.gannet
refuses 'locate: a truncated model' 'cut.gannet: ' "${locate[@]}" --model cut.gannet
for roi in 150,10,40,40 -5,10,40,40 10,100,40,40 10,10,2147483647,40 2147483647,10,40,40; do
  refuses "locate: rectangle $roi" '--roi: the rectangle lies outside the 160x120 image' "${locate[@]}" --roi $roi
done
refuses 'locate: a tiny rectangle' '--roi: the rectangle must be at least 8x8' "${locate[@]}" --roi 10,10,7,40
refuses 'locate: three numbers' "--roi: '1,2,3' is not of the form X,Y,W,H" "${locate[@]}" --roi 1,2,3
refuses 'locate: parts of pixels' '--roi: .*not a whole number' "${locate[@]}" --roi 1.5,2,30,30
refuses 'locate: an unknown optimiser' "--optimiser: 'rm-ga' is none of .*did you mean rm_ga" \
  "${locate[@]}" --model crab.gannet --optimiser rm-ga
refuses 'locate: an unknown fitness' "--fitness: 'p003' is none of" "${locate[@]}" --model crab.gannet --fitness p003
refuses 'locate: p000 with a model' '--fitness: p000 is for --roi' "${locate[@]}" --model crab.gannet --fitness p000
refuses 'locate: p002 with a rectangle' '--fitness: p002 needs a model' "${locate[@]}" --roi 50,30,50,50 --fitness p002
refuses 'locate: no depth' '--z-mm: the far end' "${locate[@]}" --model crab.gannet --z-mm 600:600
refuses 'locate: one depth' '--z-mm' "${locate[@]}" --model crab.gannet --z-mm 600
refuses 'locate: too much tilt' '--tilt-deg: 90 degrees is not 0 to 85' "${locate[@]}" --model crab.gannet --tilt-deg 90
refuses 'locate: no evaluations' '--evaluations: 0' "${locate[@]}" --model crab.gannet --evaluations 0
refuses 'locate: unknown kernels' 'no kernels "sse9"' "${locate[@]}" --model crab.gannet --simd sse9
refuses 'locate: an overlay into nowhere' 'no/such/o.png' "${locate[@]/empty.png/target.png}" --roi 50,30,60,60 \
  --z-mm 100:10000 --overlay no/such/o.png
refuses 'locate: an overlay over an input' 'is the input --left' "${locate[@]/empty.png/target.png}" \
  --roi 50,30,60,60 --z-mm 100:10000 --overlay ./target.png
for case in "--model no.gannet" "--roi 150,10,40,40" "--model crab.gannet --optimiser x" "--modle crab.gannet"; do
  # shellcheck disable=SC2086
  refuses "locate: JSON for $case" '.' "${locate[@]}" $case --json
  grep -Eq '^\{"found":false,"error":".+"\}$' out.txt && [ "$(wc -l <out.txt)" -eq 1 ] ||
    fail "locate: JSON for $case" "$(cat out.txt)"
done

"${locate[@]}" --roi 60,40,20,20 --evaluations 10 --json 2>err.txt >/dev/full
[ $? -eq 2 ] && grep -q 'standard output' err.txt && pass ||
  fail 'locate: an answer that cannot be written' "$(cat err.txt)"

# ---- track and map
mkdir -p frames/left frames/right
cp target.png frames/left/1.png
track=("$gannet" track --rig rig.toml --model crab.gannet --csv rows.csv)
echo old >rows.csv
refuses 'track: a missing folder' 'nowhere' "${track[@]}" nowhere
refuses 'track: an image without its twin' '1|right' "${track[@]}" frames
cp cut.png frames/right/1.png
refuses 'track: a truncated image' 'frames/right/1.png.*byte' "${track[@]}" frames
cp empty.png frames/right/1.png
printf 'frame,time_s\n1,abc\n' >frames/times.csv
refuses 'track: a bad time' 'times.csv:2' "${track[@]}" frames
refuses 'track: no model' '--model is missing' "$gannet" track --rig rig.toml frames
refuses 'track: zero rate' '--fps: 0' "${track[@]}" frames --fps 0
[ "$(cat rows.csv)" = old ] && pass || fail 'the old rows are as they were'
map=("$gannet" map --rig rig.toml --left target.png --right empty.png --model crab.gannet)
refuses 'map: another ending' "does not end in .png" "${map[@]}" -o map.jpg --z-mm 500
refuses 'map: turned without depth' '--rpy-deg needs --z-mm' "${map[@]}" -o map.png --rpy-deg 0,0,0
refuses 'map: too fine' '--step-mm: gives more than' "${map[@]}" -o map.png --z-mm 100000 --step-mm 0.1
refuses 'map: no step' '--step-mm: 0' "${map[@]}" -o map.png --z-mm 500 --step-mm 0

# ---- the daemon's socket
for command in status arm disarm reset stop 'config show' events top 'target none' 'goal 0,0,500' 'manual 0,0,0'; do
  # shellcheck disable=SC2086
  refuses "$command: a socket that nobody serves" 'nobody.sock' "$gannet" $command --socket "$work/nobody.sock"
done
refuses 'status: a file that is no socket' 'rig.toml' "$gannet" status --socket rig.toml
refuses 'target: an unknown kind' "kind: 'fish' is none of model, roi, none" "$gannet" target fish
refuses 'target: half a rectangle' 'not of the form X,Y,W,H' "$gannet" target roi 1,2,3
refuses 'goal: two numbers' 'not of the form X,Y,Z' "$gannet" goal 1,2
refuses 'goal: a word, as JSON' "'abc' is not a number" "$gannet" goal 0,0,abc --json
grep -q '"code":"bad_params"' out.txt && pass || fail 'goal: the JSON error on standard output'
refuses 'a mistyped subcommand' "'lcoate' is no subcommand .did you mean locate" "$gannet" lcoate
refuses 'no subcommand' 'a subcommand is missing' "$gannet"

ending

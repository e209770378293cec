#!/bin/sh
# demo.sh BUILD OUT: the main job, shown. Steps a scenario in which an ROV comes to a moving target
# and holds it, runs the same live for 20 s, finds planes in a real stereo pair of known depth, and
# makes OUT/report.html of all that. Exit 1 if a check of the stepped run or a depth failed; what
# the live run measures decides nothing, since it hangs on the machine's load.
set -eu
export LC_ALL=C
bin=$1/bin
out=$2
assets=${GANNET_ASSETS:-build/assets}
scenario=tests/scenarios/rov_station_keeping.toml

mkdir -p "$out/stereo"
rm -rf "$out/stepped" "$out/live"
rm -f "$out/report.html" "$out"/stereo/*

echo "== 1. stepped: the ROV comes to a moving target and holds it; the checks decide"
verdict=0
"$bin/gannet-world" "$scenario" --stepped --record "$out/stepped" --keep-every 15 || verdict=$?
[ "$verdict" -le 1 ] || exit 1

echo
echo "== 2. live, 20 s: the same by the machine's own clock; its times decide nothing"
live=0
"$bin/gannet-world" "$scenario" --live --duration-s 20 --record "$out/live" || live=$?
[ "$live" -le 1 ] || { echo "demo: the live run broke off" >&2; exit 1; }
echo "(live: whatever the verdict, it decides nothing here)"

echo
echo "== 3. real: depth of planes in Middlebury's Motorcycle pair, found and known"
# Scharstein et al., GCPR 2014. Its published calibration at a quarter of the full size, as the pair
# is packaged.
cp "$assets/motorcycle_left.png" "$out/stereo/left.png"
cp "$assets/motorcycle_right.png" "$out/stereo/right.png"
gzip -dc <"$assets/motorcycle_disp.npz" >"$out/stereo/disparity.npy"  # a zip of one file
{
  for camera in "left 311.193" "right 342.279"; do
    printf '[%s]\nwidth = 741\nheight = 500\nfx = 994.978\nfy = 994.978\ncx = %s\ncy = 254.877\n' \
      "${camera% *}" "${camera#* }"
  done
  printf '[right_from_left]\nrotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]\n'
  printf 'translation_m = [-0.193001, 0, 0]\n'
} >"$out/stereo/rig.toml"
cat >"$out/stereo/rectangles.csv" <<'END'
name,x,y,width,height
side cover,285,249,59,45
engine cover,338,304,56,52
fuel tank,398,184,58,36
carton below the shelf,623,201,57,73
carton on the shelf,530,36,72,58
white door,219,19,79,81
END
sed 1d "$out/stereo/rectangles.csv" | while IFS=, read -r name x y width height; do
  "$bin/gannet" locate --rig "$out/stereo/rig.toml" --left "$out/stereo/left.png" \
    --right "$out/stereo/right.png" --roi "$x,$y,$width,$height" --z-mm 1500:6000 --tilt-deg 65 \
    --json >"$out/stereo/$name.json" || [ $? -eq 1 ]
done

echo
echo "== 4. figures"
"$bin/gannet" report "$out/stepped" "$out/live" --stereo "$out/stereo" -o "$out/report.html" \
  --picture "$out/station_keeping.jpg"

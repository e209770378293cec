# Sourced by the scripts of tests/system: counts cases, works in a folder of its own, finds the
# programs of $GANNET_BUILD, and has the pictures and the small rig that several of them use.
#   . "$(dirname "$0")/../support/cases.sh"; programs gannet gannetd; …; ending
# `gannet`, `gannetd`, …: paths of the programs; `pictures`: folder of the 160x120 pictures.
set -u
pictures=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../system/pictures")
passed=0
failed=0

# programs NAME …: sets a variable of that name for each, enters an empty folder that goes at the end.
programs() {
  local build=${GANNET_BUILD:-build/release} name
  for name; do
    [ -x "$build/bin/$name" ] || { echo "no $build/bin/$name: run make first"; exit 77; }
    printf -v "${name//-/_}" %s "$(realpath "$build/bin/$name")"
  done
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cd "$work" || exit 1
}

pass() { passed=$((passed + 1)); }
fail() {  # NAME LINE …
  failed=$((failed + 1))
  printf 'FAILED %s\n' "$1"
  [ $# -lt 2 ] || printf '  %s\n' "${@:2}"
}
check() {  # NAME COMMAND …: passed if it succeeds; else what is in out.txt is shown
  if "${@:2}"; then pass; else fail "$1" "$(head -c 600 out.txt 2>/dev/null)"; fi
}
ending() {  # the last line, and the script's exit code
  echo "$passed passed, $failed failed, 0 skipped"
  [ $failed -eq 0 ]
}

# Two cameras of 160x120 pixels. small_rig [BASELINE] [FX] [ROTATION]: by default 1 mm apart, so that
# at 400 mm the eyes differ by 0.4 pixels and one photo serves both.
small_rig() {
  local camera
  for camera in "left fx = ${2:-160.0}" 'right fx = 160.0'; do
    printf '[%s]\nwidth = 160\nheight = 120\n%s\nfy = 160.0\ncx = 79.5\ncy = 59.5\n' \
      "${camera%% *}" "${camera#* }"
  done
  printf '[right_from_left]\nrotation = %s\ntranslation_m = %s\n' \
    "${3:-[1, 0, 0, 0, 1, 0, 0, 0, 1]}" "${1:-[-0.001, 0, 0]}"
}

# disc.gannet, a model of what target.png shows, photographed at 400 mm with rig.toml.
build_disc() {
  "$gannet" model build --rig rig.toml --target "$pictures/target.png" \
    --mask "$pictures/mask.png" --distance-mm 400 --name disc -o disc.gannet
}

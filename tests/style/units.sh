#!/bin/bash
# The systemd files: units that systemd reads without a complaint, a sandbox whose exposure stays at
# or below 1.5, a reason above each line, and the shipped configuration: it is accepted as soon as a
# calibration lies beside it, and says so before. Last line: "N passed, N failed, N skipped".
. "$(dirname "$0")/../support/cases.sh"
cd "$(dirname "$0")/../.." || exit 1
command -v systemd-analyze >/dev/null || { echo "no systemd-analyze"; exit 77; }
bin=$(realpath "${GANNET_BUILD:-build/release}/bin")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# As `make install` would install them, with programs that exist.
for unit in systemd/*.service systemd/*.slice; do
  sed "s,/usr/bin/gannet,$bin/gannet,g" "$unit" >"$work/${unit##*/}"
done
verify() { systemd-analyze verify --man=no "$1" >"$work/out" 2>&1; [ ! -s "$work/out" ]; }
exposed() { systemd-analyze security --offline=yes --threshold=15 "$1" >"$work/out" 2>/dev/null; }
for unit in "$work"/*.service "$work"/*.slice; do
  name=${unit##*/}
  # A template is tried with a name that an interface would have.
  if [[ $name == *@.service ]]; then cp "$unit" "$work/${name/@/@can0}"; unit=$work/${name/@/@can0}; fi
  verify "$unit" && pass || fail "systemd reads $name" "$(cat "$work/out")"
  [[ $name == *.slice ]] || { exposed "$unit" && pass || fail "exposure of $name" "$(tail -n 1 "$work/out")"; }
done

# Every directive has a comment above it, or stands in a group that has one: no two groups without.
for unit in systemd/*.service systemd/*.slice; do
  bare=$(awk '/^#/ { reason = NR } /^\[/ || /^$/ { reason = /^$/ ? reason : 0 }
    /^[A-Z][A-Za-z]*=/ && !reason && $0 !~ /^(Description|Documentation)=/ { print FILENAME ":" NR ": " $0 }
    /^\[Install\]/ { exit }' "$unit")
  [ -z "$bare" ] && pass || fail "a reason for each line" "$bare"
done

if [ -x "$bin/gannetd" ]; then
  mkdir "$work/etc"
  cp systemd/gannet.toml "$work/etc"
  "$bin/gannetd" --check "$work/etc/gannet.toml" >"$work/out" 2>&1
  [ $? -eq 2 ] && grep -q 'gannet.toml:[0-9]*: rig: .*rig.toml' "$work/out" && pass ||
    fail "the shipped configuration asks for a calibration" "$(cat "$work/out")"
  cp docs/examples/rig.toml "$work/etc"
  "$bin/gannetd" --check "$work/etc/gannet.toml" >"$work/out" 2>&1 && pass ||
    fail "the shipped configuration is accepted with one" "$(cat "$work/out")"
  for example in docs/examples/*.toml; do
    [[ $example == *rig.toml ]] && continue  # a calibration: the examples beside it name it
    # What --check looks for in a recording is in tests/system; an example's own is not shipped.
    more=()
    grep -q '^kind = "replay"' "$example" && more=(--set camera.kind=simulated)
    "$bin/gannetd" --check "$example" "${more[@]}" >"$work/out" 2>&1 && pass ||
      fail "$example" "$(cat "$work/out")"
  done
fi
ending

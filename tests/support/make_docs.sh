#!/bin/bash
# Writes the manual pages and references from the programs' own descriptions:
#   make_docs.sh BUILD [OUT]      into OUT/man and OUT/reference; OUT is docs/ by default.
set -eu
bin=$1/bin
out=${2:-docs}
mkdir -p "$out/man" "$out/reference"
"$bin/gannet" --man-page >"$out/man/gannet.1"
"$bin/gannet" --reference subcommands | while read -r words; do
  # shellcheck disable=SC2086
  "$bin/gannet" $words --man-page >"$out/man/gannet-${words// /-}.1"
done
"$bin/gannetd" --man-page >"$out/man/gannetd.8"
"$bin/gannet-world" --man-page >"$out/man/gannet-world.1"
"$bin/gannet-world" paper --man-page >"$out/man/gannet-world-paper.1"
"$bin/gannet" --reference gannet.toml.5 >"$out/man/gannet.toml.5"
"$bin/gannet" --reference gannet.toml.md >"$out/reference/gannet.toml.md"
"$bin/gannet" --reference rig.md >"$out/reference/rig.md"
"$bin/gannet" --reference gannet-cia402.eds >"$out/reference/gannet-cia402.eds"
for name in vesc.dbc odrive.dbc dronecan.md; do
  "$bin/gannet" --reference "$name" >"$out/reference/$name"
done

#!/bin/bash
# decode.sh RESULTS: what foreign programs read in a scenario's recorded bus: tshark, with its CANopen
# dissector where the bus speaks that, and python-can. One line each, to be read by people and judge.sh.
# DroneCAN v0 neither knows; there the ids, lengths and periods are what they can tell.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
log=$(mktemp --suffix=.log)
trap 'rm -f "$log"' EXIT
# Into candump's own log format, without error frames.
awk 'NF >= 3 && $3 ~ /^[0-9A-F]+$/ && $4 ~ /^\[[0-8]\]$/ {
  data = ""; for (i = 5; i < 5 + substr($4, 2, 1); i++) data = data $i
  if (/ERRORFRAME/) next
  print $1, $2, $3 "#" data}' "$1/can" >"$log"
echo "frames recorded: $(wc -l <"$log")"
if command -v tshark >/dev/null; then
  by_tshark() { tshark -r "$log" "$@" 2>/dev/null; }
  echo "tshark: frames: $(by_tshark | wc -l)"
  echo "tshark: malformed: $(by_tshark -Y _ws.malformed | wc -l)"
  echo "tshark: frames with an identifier of 29 bits: $(by_tshark -Y 'can.flags.xtd == 1' | wc -l)"
  if ! grep -qE '^[^ ]+ [^ ]+ [0-9A-F]{8}#' "$log"; then
    # Node 0x0A is gannetd.
    canopen() { by_tshark -d can.subdissector,canopen "$@"; }
    echo "tshark: CANopen: $(canopen -Y canopen | wc -l)"
    echo "tshark: SDO writes: $(canopen -Y 'canopen.sdo.ccs == 1' | wc -l)"
    echo "tshark: SDO refused: $(canopen -Y canopen.sdo.abort_code | wc -l)"
    echo "tshark: drives operational: $(canopen -Y 'canopen.nmt_guard.state == 5 && canopen.node_id != 0x0a' \
      -T fields -e canopen.node_id | sort -u | wc -l)"
    echo "tshark: heartbeats of the daemon: $(canopen -Y 'canopen.nmt_guard.state && canopen.node_id == 0x0a' | wc -l)"
    echo "tshark: SYNC: $(canopen -Y 'can.id == 0x80' | wc -l)"
    echo "tshark: emergencies: $(canopen -Y canopen.em.err_code | wc -l)"
  fi
else
  echo "tshark: not installed"
fi
if /usr/bin/python3 -c 'import can' 2>/dev/null; then
  /usr/bin/python3 "$here/decode.py" "$log"
else
  echo "python-can: not installed"
fi

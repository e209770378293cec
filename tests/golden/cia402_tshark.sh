#!/bin/bash
# A foreign program reads the kept CiA 402 session (cia402_session.log, which the unit tests of
# src/world hold equal to what drive and drives say today): tshark's CANopen dissector must find in
# it what we meant. Skips without tshark.
set -u
cd "$(dirname "$0")/../.." || exit 2
command -v tshark >/dev/null || { echo "no tshark"; exit 77; }
log=tests/golden/cia402_session.log
read_log() { tshark -r "$log" -d can.subdissector,canopen "$@" 2>/dev/null; }
read_log -c 1 | grep -q CANopen || { echo "this tshark cannot read candump logs as CANopen"; exit 77; }

passed=0 failed=0
same() {  # same NAME EXPECTED FOUND
  if [ "$2" == "$3" ]; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAIL  $1"
    diff <(echo "$2") <(echo "$3")
  fi
}
fields() { read_log -Y "$1" -T fields -E separator=' ' "${@:2}" | sed 's/[[:space:]]*$//'; }

same "no frame is malformed" "" "$(read_log -Y _ws.malformed)"
same "every frame is CANopen" "$(grep -c . "$log")" "$(fields canopen -e frame.number | grep -c .)"
same "NMT commands: pre-operational, again after the boot-up, start" "0x80 0x15
0x80 0x15
0x01 0x15" "$(fields canopen.nmt_ctrl.cd -e canopen.nmt_ctrl.cd -e canopen.nmt_ctrl.node_id)"
same "the drive boots, waits, works, and falls back when the master dies" "0x00
0x7f
0x05
0x7f" "$(fields 'canopen.nmt_guard.state && canopen.node_id == 0x15' -e canopen.nmt_guard.state | uniq)"
same "the master says that it is operational" "0x05" \
  "$(fields 'canopen.nmt_guard.state && canopen.node_id == 0x0a' -e canopen.nmt_guard.state | uniq)"
same "emergencies: too hot, gone, heartbeat lost" "0x4310 0x09
0x0000 0x00
0x8130 0x11" "$(fields canopen.em.err_code -e canopen.em.err_code -e canopen.em.err_reg)"
same "objects written, in this order" "0x6040:0x00 0x1017:0x00 0x1400:0x01 0x1600:0x00 0x1600:0x01 0x1600:0x02 0x1600:0x00 0x1400:0x02 0x1400:0x01 0x1800:0x01 0x1a00:0x00 0x1a00:0x01 0x1a00:0x02 0x1a00:0x03 0x1a00:0x00 0x1800:0x02 0x1800:0x01 0x1801:0x01 0x1802:0x01 0x1803:0x01 0x6060:0x00 0x605a:0x00 0x1006:0x00 0x1016:0x01 0x1029:0x01 0x6007:0x00" \
  "$(fields 'canopen.sdo.ccs == 1' -e canopen.sdo.main_idx -e canopen.sdo.sub_idx | tr ' ' ':' | paste -sd' ')"
same "all of them expedited, with their size said" "1 1" \
  "$(fields 'canopen.sdo.ccs == 1' -e canopen.sdo.e -e canopen.sdo.s | sort -u)"
same "none was refused" "" "$(fields canopen.sdo.abort_code -e canopen.sdo.abort_code)"
same "every request was answered" "$(fields 'canopen.sdo.ccs' -e frame.number | grep -c .)" \
  "$(fields 'canopen.sdo.scs' -e frame.number | grep -c .)"
# Control and status words of the PDOs, by the data bytes that tshark shows.
same "control words: stop, off, on, run, off, reset, on, run, quick stop" "0200 0000 0600 0700 0f00 0000 8000 0000 0600 0700 0f00 0200 0000" \
  "$(fields 'canopen.function_code == 4' -e canopen.pdo.data.bytes | cut -c1-4 | uniq | paste -sd' ')"
echo "$passed passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]

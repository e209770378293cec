#!/bin/bash
# The DBC files, read by cantools, an implementation of others, where it is installed: it decodes the
# frames that the firmware's documents, other programs' tests and a user's capture show, and encodes
# the same bytes again.
set -u
python=${GANNET_PYTHON:-python3}
"$python" -c 'import cantools' 2>/dev/null || { echo "no cantools: skipped"; exit 77; }
"$python" - <<'PYTHON'
import cantools

vesc = cantools.database.load_file("docs/reference/vesc.dbc")
odrive = cantools.database.load_file("docs/reference/odrive.dbc")
passed = failed = 0


def check(database, name, frame_id, data, expected):
    global passed, failed
    data = bytes.fromhex(data)
    message = database.get_message_by_name(name)
    decoded = database.decode_message(message.frame_id, data)
    good = message.frame_id == frame_id and message.length >= len(data)
    for signal, value in expected.items():
        good = good and abs(decoded[signal] - value) < 1e-6 * max(1, abs(value))
    if len(data) == message.length:
        good = good and bytes(message.encode(decoded)) == data
    passed, failed = passed + good, failed + (not good)
    if not good:
        print(f"{name}: {frame_id:X} {data.hex()} decodes to {decoded}, not {expected}")


check(vesc, "Vesc7_Status", 0x907, "0000508C007B0041",
      {"ElectricalSpeed": 20620, "MotorCurrent": 12.3, "Duty": 0.065})
check(vesc, "Vesc7_Status", 0x907, "FFFFAF74FF85FFBF",
      {"ElectricalSpeed": -20620, "MotorCurrent": -12.3, "Duty": -0.065})
check(vesc, "Vesc7_SetCurrent", 0x107, "0000C738", {"Current": 51})
check(vesc, "Vesc1_SetDuty", 0x001, "FFFF4674", {"Duty": -0.475})
check(vesc, "Vesc2_Status4", 0x1002, "00FA01F400140032",
      {"FetTemperature": 25, "MotorTemperature": 50, "InputCurrent": 2, "Position": 1})
check(vesc, "Vesc3_Status5", 0x1B03, "0000000C00A00000", {"Tachometer": 2, "InputVoltage": 16})
check(vesc, "Vesc4_ShortPacket", 0x804, "0A01320000800004",
      {"Sender": 10, "IsAnswer": 1, "Packet": 50, "Mask": 0x8000, "Value": 4})
check(odrive, "Odrive8_Heartbeat", 0x101, "0000000008000000", {"AxisError": 0, "AxisState": 8})
check(odrive, "Odrive1_Heartbeat", 0x021, "010000000B000000", {"AxisError": 1, "AxisState": 11})
check(odrive, "Odrive1_GetBusVoltageCurrent", 0x037, "33F5424100000000",
      {"BusVoltage": 12.184863, "BusCurrent": 0})
check(odrive, "Odrive3_SetInputVelocity", 0x06D, "000080BF00000000",
      {"InputVelocity": -1, "TorqueFeedForward": 0})
check(odrive, "Odrive3_SetAxisState", 0x067, "08000000", {"RequestedState": 8})
print(f"{passed} passed, {failed} failed, 0 skipped")
raise SystemExit(failed != 0)
PYTHON

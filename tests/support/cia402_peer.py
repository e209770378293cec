"""A foreign CANopen node on a local bus, for tests/unit/src/world/cia402_foreign_test.cpp.

  cia402_peer.py master BUS EDS   leads our simulated drive (node 21) through its states
  cia402_peer.py slave BUS EDS    is a drive (node 21) for our drive group, until it is killed

Needs python-can and canopen (python-canopen). Exit 0: all was as it should be.
"""
import socket
import struct
import sys
import time

import can
import canopen
from canopen.profiles.p402 import BaseNode402

NODE = 21
FRAME = struct.Struct("<IB3x8s")  # struct can_frame of linux/can.h


class LocalBus(can.BusABC):
    """A node of Gannet's local CAN bus: each message of the socket is one frame."""

    def __init__(self, path):
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.connect(path)
        super().__init__(channel=path)

    def _recv_internal(self, timeout):
        self.socket.settimeout(timeout or 0.001)
        try:
            data = self.socket.recv(FRAME.size)
        except (socket.timeout, OSError):
            return None, False
        if len(data) != FRAME.size:
            return None, False
        can_id, length, payload = FRAME.unpack(data)
        message = can.Message(arbitration_id=can_id & 0x7FF, is_extended_id=False,
                              data=payload[:length], timestamp=time.time())
        return message, False

    def send(self, msg, timeout=None):
        self.socket.send(FRAME.pack(msg.arbitration_id, msg.dlc, bytes(msg.data).ljust(8, b"\0")))


def master(network, eds):
    node = BaseNode402(NODE, eds)
    network.add_node(node)
    emergencies = []
    node.emcy.add_callback(lambda e: emergencies.append(e.code))
    node.nmt.state = "RESET"
    node.nmt.wait_for_bootup(2)
    assert node.sdo["Device type"].raw & 0xFFFF == 402
    assert node.sdo["Supported drive modes"].raw == 0x104
    node.sdo["Producer heartbeat time"].raw = 50
    node.nmt.wait_for_heartbeat(1)
    assert node.nmt.state == "PRE-OPERATIONAL", node.nmt.state
    try:
        node.sdo["Device type"].raw = 1
        raise SystemExit("a read-only object was written")
    except canopen.SdoAbortedError as error:
        assert error.code == 0x06010002, hex(error.code)
    try:
        node.sdo.upload(0x5000, 0)
        raise SystemExit("an object that is not there was read")
    except canopen.SdoAbortedError as error:
        assert error.code == 0x06020000, hex(error.code)
    node.setup_402_state_machine()
    node.nmt.state = "OPERATIONAL"
    node.op_mode = "PROFILED VELOCITY"
    assert node.op_mode == "PROFILED VELOCITY"
    for state in ("SWITCH ON DISABLED", "READY TO SWITCH ON", "SWITCHED ON", "OPERATION ENABLED"):
        node.state = state
        assert node.state == state, (node.state, state)
    node.sdo["Target velocity"].raw = 600
    time.sleep(0.3)
    assert abs(node.sdo["Velocity actual value"].raw - 600) <= 2
    node.state = "QUICK STOP ACTIVE"
    deadline = time.time() + 1
    while node.state != "SWITCH ON DISABLED" and time.time() < deadline:
        time.sleep(0.02)
    assert node.state == "SWITCH ON DISABLED", node.state
    # Nobody's heartbeat 100 ms long, after one: that is an emergency, then pre-operational.
    node.sdo["Consumer heartbeat time"][1].raw = 5 << 16 | 100
    network.send_message(0x705, [5])
    time.sleep(0.4)
    assert emergencies == [0x8130], emergencies
    assert node.nmt.state == "PRE-OPERATIONAL", node.nmt.state


class Drive:
    """The states of a drive by python-canopen's own table of them."""

    def __init__(self, network, eds):
        self.network = network
        self.status, self.target = 0x0250, 0
        self.local = canopen.LocalNode(NODE, eds)
        network.add_node(self.local)
        self.local.add_write_callback(self.written)
        network.subscribe(0x080, self.sync)
        network.subscribe(0x200 + NODE, self.command)
        self.local.nmt.state = "INITIALISING"
        self.local.nmt.state = "PRE-OPERATIONAL"

    def written(self, index, subindex, od, data):
        if index == 0x6060:
            self.local.sdo[0x6061].raw = self.local.sdo[0x6060].raw

    def command(self, cob_id, data, timestamp):
        control, self.target = struct.unpack("<Hi", data)
        now = self.status & 0x6F
        if control & 0x02 == 0:
            self.status = 0x0250
        elif now == 0x40 and control & 0x87 == 0x06:
            self.status = 0x0231
        elif now == 0x21 and control & 0x8F == 0x07:
            self.status = 0x0233
        elif now == 0x23 and control & 0x8F == 0x0F:
            self.status = 0x0237
        elif now == 0x27 and control & 0x86 == 0x02:
            self.status = 0x0250

    def sync(self, cob_id, data, timestamp):
        if self.local.nmt.state != "OPERATIONAL":
            return
        velocity = self.target if self.status & 0x6F == 0x27 else 0
        self.network.send_message(0x180 + NODE, struct.pack("<Hih", self.status, velocity, 250))


def main():
    role, path, eds = sys.argv[1:]
    network = canopen.Network()
    network.bus = LocalBus(path)
    network.connect()
    if role == "master":
        master(network, eds)
        network.disconnect()
        return
    drive = Drive(network, eds)
    while True:
        time.sleep(1)


main()

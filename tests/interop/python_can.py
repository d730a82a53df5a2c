"""python-can reads and writes the simulated hand 7 through a serial CAN adapter: python_can.py slcan|robotell PORT

The maker's own adapter has the packets of Robotell's."""

import sys

import can

ANGLE_ACT, SPEED_SET, HAND = 1546, 1522, 7


def ask(bus, way, address, data):
    identifier = way << 26 | address << 14 | HAND
    bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=True))
    reply = bus.recv(5)
    assert reply is not None, f"no reply about {address}"
    assert reply.is_extended_id and reply.arbitration_id == identifier, reply
    return bytes(reply.data)


interface, port = sys.argv[1:]
options = {"sleep_after_open": 0.2} if interface == "slcan" else {}
with can.Bus(interface=interface, channel=port, bitrate=1_000_000, **options) as bus:
    assert ask(bus, 0, ANGLE_ACT, [8]) == bytes.fromhex("E803") * 4
    assert ask(bus, 0, ANGLE_ACT + 8, [4]) == bytes.fromhex("E803") * 2
    assert len(ask(bus, 1, SPEED_SET, [0x64, 0])) == 1
    assert ask(bus, 0, SPEED_SET, [2]) == bytes([0x64, 0])
    # Bytes that a packet has another sign before.
    assert len(ask(bus, 1, SPEED_SET, [0xAA, 0, 0x55, 0, 0xA5, 0])) == 1
    assert ask(bus, 0, SPEED_SET, [6]) == bytes([0xAA, 0, 0x55, 0, 0xA5, 0])
print(f"python-can and the simulated adapter understand each other: {interface}")

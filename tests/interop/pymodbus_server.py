"""pymodbus plays the hand, over TCP and over RTU on a pseudo-terminal, and handscope reads it:
pymodbus_server.py HANDSCOPE FOLDER"""

import asyncio
import json
import os
import pathlib
import pty
import socket
import subprocess
import sys
import threading
import tty

try:
    from pymodbus.constants import ExcCodes
    from pymodbus.server import ModbusSerialServer, ModbusTcpServer
    from pymodbus.simulator import DataType, SimData, SimDevice
except ImportError as missing:
    sys.exit(print(f"not tried: this pymodbus has no device simulator ({missing})"))

# The manual's byte addresses, and what this hand says there.
ANGLES, FORCES, CURRENTS = 1546, 1582, 1594
ANGLE_ACT = [1000, 857, 714, 571, 428, 285]
FORCE_ACT = [-33, -5, 0, 241, 500, 1000]
CURRENT = [0, 12, 120, 900, 1500, 2000]
TEMP = [31, 32, 33, 34, 35, 36]
ERROR = [0, 0, 0b100, 0, 0, 0]
STATUS = [2, 2, 5, 2, 3, 2]
DIRECTION = 271
# What it does not answer: the unused addresses, and a register that this edition lacks.
REFUSED = [range(1558, 1582), range(1700, 1704)]

memory = bytearray(4096)


def put(address, values, size=2):
    for at, value in enumerate(values):
        memory[address + size * at : address + size * (at + 1)] = value.to_bytes(size, "little", signed=value < 0)


put(1000, [7], 1)
put(1486, ANGLE_ACT)
put(1498, [500] * 6)
put(1522, [250] * 6)
put(ANGLES, ANGLE_ACT)
put(FORCES, FORCE_ACT)
put(CURRENTS, CURRENT)
put(1606, ERROR, 1)
put(1612, STATUS, 1)
put(1618, TEMP, 1)
for finger in range(5):
    block = 3000 + 58 * finger
    put(block, [2_900_000 + finger] * 8, 4)
    put(block + 48, [DIRECTION])
    put(block + 54, [sum(memory[block : block + 54]) & 0xFFFF])


async def act(function, start, address, count, registers, values):
    """A word covers two byte addresses, low byte first; a list of consecutive words would be another device."""
    if address + 2 * count > len(memory) or any(
        gap.start < address + 2 * count and address < gap.stop for gap in REFUSED
    ):
        return ExcCodes.ILLEGAL_ADDRESS
    for at in range(count):
        byte = address + 2 * at
        if values:
            memory[byte : byte + 2] = int(values[at]).to_bytes(2, "little")
        registers[address - start + at] = int.from_bytes(memory[byte : byte + 2], "little")


def device(unit):
    return SimDevice(unit, simdata=[SimData(0, count=4096, values=0, datatype=DataType.REGISTERS)], action=act)


def pump(source, sink):
    while True:
        try:
            os.write(sink, os.read(source, 512))
        except OSError:
            return


def line(link):
    """Two pseudo-terminals back to back: ours behind `link`, and the path of the other."""
    (near, ours), (far, theirs) = pty.openpty(), pty.openpty()
    for end in (near, ours, far, theirs):
        tty.setraw(end)
    for way in ((near, far), (far, near)):
        threading.Thread(target=pump, args=way, daemon=True).start()
    pathlib.Path(link).unlink(missing_ok=True)
    os.symlink(os.ttyname(ours), link)
    return os.ttyname(theirs)


def handscope(*words, code=0):
    ended = subprocess.run([sys.argv[1], *words], capture_output=True, text=True, timeout=60)
    assert ended.returncode == code, (words, ended)
    return ended


def check(hand):
    read = json.loads(
        handscope("read", "HAND_ID", "ANGLE_ACT", "FORCE_ACT", "CURRENT", "TEMP", "--json", "--hand", hand).stdout
    )
    assert read["HAND_ID"] == 7, read
    assert (read["ANGLE_ACT"], read["FORCE_ACT"]) == (ANGLE_ACT, FORCE_ACT), read
    assert (read["CURRENT"], read["TEMP"]) == (CURRENT, TEMP), read
    refused = handscope("read", "IP_PART1", "--hand", hand, code=1)
    assert "llegal data address" in refused.stderr, refused.stderr
    lines = [json.loads(line) for line in handscope("watch", "--json", "--for", "2", "--hand", hand).stdout.splitlines()]
    stats, last = lines.pop()["stats"], lines[-1]
    assert last["angle"] == ANGLE_ACT and last["force_g"] == FORCE_ACT, last
    assert last["current_ma"] == CURRENT and last["temp_c"] == TEMP, last
    assert last["error_raw"] == ERROR and last["status_raw"] == STATUS, last
    assert [tip["direction_deg"] for tip in last["tactile"]] == [DIRECTION] * 5, last
    assert all(tip["check_ok"] for tip in last["tactile"]), last
    assert stats["writes"] == 0 and stats["reconnects"] == 0, stats
    print(f"{hand.split(':')[0]}: {stats['state_reads']} states, {stats['tactile_reads']} sweeps, refusals {stats['refusals']}")


async def main():
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    link = str(pathlib.Path(sys.argv[2]) / "pymodbus-line")
    tcp = ModbusTcpServer(device(255), address=("127.0.0.1", port))
    rtu = ModbusSerialServer(device(1), port=line(link), baudrate=115_200)
    for server in (tcp, rtu):
        await server.serve_forever(background=True)
    for hand in (f"tcp:127.0.0.1:{port}", f"rtu:{link}"):
        await asyncio.to_thread(check, hand)
    for server in (tcp, rtu):
        await server.shutdown()
    print("pymodbus as a hand is read right over TCP and RTU")


asyncio.run(main())

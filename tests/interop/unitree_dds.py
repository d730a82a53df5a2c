"""Unitree's end of DDS, which is CycloneDDS 0.10.2 with their types and default qualities, as inspire_sdkpy and xr_teleoperate use
it: unitree_dds.py ADDRESS DOMAIN SIDE COMMANDS. Waits for a state, as xr_teleoperate does, then sends that many commands, 100 a
second, each other than the one before. Prints what it met as JSON, a line when the first state came and one at the end."""

import json
import sys
import time
from dataclasses import dataclass

import cyclonedds.idl as idl
import cyclonedds.idl.annotations as annotate
import cyclonedds.idl.types as types
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic


@dataclass
@annotate.final
@annotate.autoid("sequential")
class inspire_hand_ctrl(idl.IdlStruct, typename="inspire.inspire_hand_ctrl"):
    pos_set: types.sequence[types.int16, 6]
    angle_set: types.sequence[types.int16, 6]
    force_set: types.sequence[types.int16, 6]
    speed_set: types.sequence[types.int16, 6]
    mode: types.int8


@dataclass
@annotate.final
@annotate.autoid("sequential")
class inspire_hand_state(idl.IdlStruct, typename="inspire.inspire_hand_state"):
    pos_act: types.sequence[types.int16, 6]
    angle_act: types.sequence[types.int16, 6]
    force_act: types.sequence[types.int16, 6]
    current: types.sequence[types.int16, 6]
    err: types.sequence[types.uint8, 6]
    status: types.sequence[types.uint8, 6]
    temperature: types.sequence[types.uint8, 6]


CONFIG = """<CycloneDDS><Domain Id="any"><General><Interfaces>
<NetworkInterface address="{}" priority="default" multicast="default"/>
</Interfaces></General></Domain></CycloneDDS>"""
address, domain, side, commands = sys.argv[1], int(sys.argv[2]), sys.argv[3], int(sys.argv[4])
begun = time.monotonic()
config = Domain(domain, CONFIG.format(address))
participant = DomainParticipant(domain)
reader = DataReader(participant, Topic(participant, f"rt/inspire_hand/state/{side}", inspire_hand_state))
writer = DataWriter(participant, Topic(participant, f"rt/inspire_hand/ctrl/{side}", inspire_hand_ctrl))


def tell(**words):
    print(json.dumps(words), flush=True)


states, newest = 0, None


def read():
    """Takes what came, as their reading thread does each 2 ms."""
    global states, newest
    sample = next(iter(reader.take(1)), None)
    if sample is not None:
        states, newest = states + 1, sample
    return sample is not None


while newest is None and time.monotonic() < begun + 20:
    read()
    time.sleep(0.002)
assert newest is not None, "no state came within 20 s"
first = time.monotonic() - begun
for name in ["pos_act", "angle_act", "force_act", "current", "err", "status", "temperature"]:
    assert len(getattr(newest, name)) == 6, newest
tell(first_state_s=first, angle_act=list(newest.angle_act), temperature=list(newest.temperature))
counted, start = states, time.monotonic()
for n in range(commands):
    # xr_teleoperate's own message: only angles are meant, the other lists are zero.
    index = 1000 - 2 * (n % 250)
    angles = [-1, -1, -1, index, -1, -1]
    writer.write(inspire_hand_ctrl([0] * 6, angles, [0] * 6, [0] * 6, 0b0001))
    until = start + (n + 1) * 0.01
    while time.monotonic() < until:
        if not read():
            time.sleep(0.001)
took = time.monotonic() - start
tell(sent=commands, states=states - counted, took_s=took, angle_act=list(newest.angle_act))

"""Unitree's end of DDS: CycloneDDS 0.10.2 with their types and the qualities that it has unless told otherwise, as inspire_sdkpy
and xr_teleoperate use it, and ROS 2's types beside. Usage: unitree_dds.py ADDRESS DOMAIN SIDE COMMANDS ROUNDS.

In each round it waits for states, as xr_teleoperate does, sends that many commands, 100 a second, and then waits until nobody tells
states any more. Every other round it sends both hands as twelve motors, as for the DFX service. Prints a line of JSON when the first state of a round came, and one when its commands are sent."""

import json
import sys
import time
from dataclasses import dataclass, fields, is_dataclass
from math import isnan
from xml.etree import ElementTree

import cyclonedds.idl as idl
import cyclonedds.idl.annotations as annotate
import cyclonedds.idl.types as types
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

SHORTS, BYTES = types.sequence[types.int16, 6], types.sequence[types.uint8, 6]


@dataclass
@annotate.final
@annotate.autoid("sequential")
class inspire_hand_ctrl(idl.IdlStruct, typename="inspire.inspire_hand_ctrl"):
    pos_set: SHORTS
    angle_set: SHORTS
    force_set: SHORTS
    speed_set: SHORTS
    mode: types.int8


@dataclass
@annotate.final
@annotate.autoid("sequential")
class inspire_hand_state(idl.IdlStruct, typename="inspire.inspire_hand_state"):
    pos_act: SHORTS
    angle_act: SHORTS
    force_act: SHORTS
    current: SHORTS
    err: BYTES
    status: BYTES
    temperature: BYTES


@dataclass
@annotate.final
@annotate.autoid("sequential")
class MotorCmd_(idl.IdlStruct, typename="unitree_go.msg.dds_.MotorCmd_"):
    mode: types.uint8
    q: types.float32
    dq: types.float32
    tau: types.float32
    kp: types.float32
    kd: types.float32
    reserve: types.array[types.uint32, 3]


@dataclass
@annotate.final
@annotate.autoid("sequential")
class MotorCmds_(idl.IdlStruct, typename="unitree_go.msg.dds_.MotorCmds_"):
    cmds: types.sequence[MotorCmd_]


@dataclass
@annotate.final
@annotate.autoid("sequential")
class MotorState_(idl.IdlStruct, typename="unitree_go.msg.dds_.MotorState_"):
    mode: types.uint8
    q: types.float32
    dq: types.float32
    ddq: types.float32
    tau_est: types.float32
    q_raw: types.float32
    dq_raw: types.float32
    ddq_raw: types.float32
    temperature: types.uint8
    lost: types.uint32
    reserve: types.array[types.uint32, 2]


@dataclass
@annotate.final
@annotate.autoid("sequential")
class MotorStates_(idl.IdlStruct, typename="unitree_go.msg.dds_.MotorStates_"):
    states: types.sequence[MotorState_]


@dataclass
class Time_(idl.IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: types.int32
    nanosec: types.uint32


@dataclass
class Header_(idl.IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time_
    frame_id: str


@dataclass
class JointState_(idl.IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):
    header: Header_
    name: types.sequence[str]
    position: types.sequence[types.float64]
    velocity: types.sequence[types.float64]
    effort: types.sequence[types.float64]


@dataclass
class Touch_(idl.IdlStruct, typename="handscope_msgs.msg.dds_.Touch_"):
    asked: Time_
    received: Time_
    normal_n: types.float32
    tangential_n: types.float32
    direction_deg: types.uint16
    proximity: types.int32
    check_ok: bool
    channels: types.sequence[types.uint32]
    raw: types.sequence[types.uint8]


@dataclass
class String_(idl.IdlStruct, typename="std_msgs.msg.dds_.String_"):
    data: str


CONFIG = """<CycloneDDS><Domain Id="any"><General><Interfaces>
<NetworkInterface address="{}" priority="default" multicast="default"/>
</Interfaces></General></Domain></CycloneDDS>"""
address, domain, side = sys.argv[1], int(sys.argv[2]), sys.argv[3]
commands, rounds = int(sys.argv[4]), int(sys.argv[5])
config = Domain(domain, CONFIG.format(address))
participant = DomainParticipant(domain)


def reader(name, kind, *more):
    # Their own takes each message when it comes; this one looks each millisecond.
    return DataReader(participant, Topic(participant, name, kind), Qos(Policy.History.KeepLast(500), *more))


states = reader(f"rt/inspire_hand/state/{side}", inspire_hand_state)
# As ROS 2 does by default: none of these is lost, and there are as many as states.
joints = reader("rt/joint_states", JointState_, Policy.Reliability.Reliable(duration(seconds=1)))
touch = reader("rt/handscope/touch/index", Touch_)
motors = reader("rt/inspire/state", MotorStates_)
writer = DataWriter(participant, Topic(participant, f"rt/inspire_hand/ctrl/{side}", inspire_hand_ctrl))
motor_writer = DataWriter(participant, Topic(participant, "rt/inspire/cmd", MotorCmds_))
OWN, OTHER = (range(6), range(6, 12)) if side == "r" else (range(6, 12), range(6))


def heard(of):
    """The next message that waits. What tells only that its writer is gone is none."""
    return next((sample for sample in of.take(1) if is_dataclass(sample)), None)


def wait(wanted, within):
    until = time.monotonic() + within
    while time.monotonic() < until:
        if found := wanted():
            return found
        time.sleep(0.001)
    sys.exit("nothing came in time")


def tell(**words):
    print(json.dumps(words), flush=True)


for nth in range(rounds):
    begun = time.monotonic()
    state = wait(lambda: heard(states), 50)
    tell(first_state_s=time.monotonic() - begun, round=nth)
    assert all(len(getattr(state, field.name)) == 6 for field in fields(state)), state
    pose = wait(lambda: heard(joints), 5)
    # RViz asks for the model as robot_state_publisher tells it: once, for those that come later.
    models = reader(
        "rt/robot_description",
        String_,
        Policy.Reliability.Reliable(duration(seconds=1)),
        Policy.Durability.TransientLocal,
    )
    model = ElementTree.fromstring(wait(lambda: heard(models), 5).data)
    assert model.tag == "robot" and set(pose.name) <= {joint.get("name") for joint in model.iter("joint")}, pose.name
    while heard(states) or heard(joints) or heard(motors):
        pass
    count, told, sent, start = 0, 0, 0, time.monotonic()
    # As many states as commands, however late either comes on a computer that does other work as well.
    while sent < commands or count < commands:
        if sent < commands and time.monotonic() >= start + sent * 0.01:
            # xr_teleoperate's own message: only angles are meant, the other lists are zero.
            index = 1000 - 2 * (sent % 250)
            if nth % 2 == 0:
                angles = [-1, -1, -1, index, -1, -1]
                writer.write(inspire_hand_ctrl([0] * 6, angles, [0] * 6, [0] * 6, 0b0001))
            else:
                cmds = [MotorCmd_(0, 1.0, 0, 0, 0, 0, [0] * 3) for _ in range(12)]
                cmds[OWN[3]].q = index / 1000
                # What the other hand is sent is not looked at.
                cmds[OTHER[0]].q = float("nan")
                motor_writer.write(MotorCmds_(cmds))
            sent += 1
        while sample := heard(states):
            state, count = sample, count + 1
        while sample := heard(joints):
            pose, told = sample, told + 1
        time.sleep(0.001)
    took = time.monotonic() - start
    both = wait(lambda: heard(motors), 5).states
    assert len(both) == 12 and all(-0.1 < both[at].q < 1.1 and both[at].temperature > 10 for at in OWN), both
    assert all(isnan(both[at].q) and both[at].lost for at in OTHER), both
    tip = wait(lambda: heard(touch), 5)
    assert len(pose.name) == len(pose.position) == 12 and all(0 <= angle < 3 for angle in pose.position), pose
    assert tip.check_ok and len(tip.raw) == 58 and len(tip.channels) == 8, tip
    tell(sent=sent, states=count, told=told, took_s=took, angle_act=list(state.angle_act))
    if nth + 1 < rounds:
        quiet = time.monotonic()
        while time.monotonic() < quiet + 0.5:
            while heard(states) or heard(joints) or heard(motors):
                quiet = time.monotonic()
            time.sleep(0.01)

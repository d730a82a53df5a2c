"""A hand on DDS as ROS 2 programs meet it: CycloneDDS with the type names that ROS 2 uses. It reads the model, the frames and the
joints, moves the index finger by JointTrajectory and by JointState, and stops it by a trajectory without points.

Usage: ros_dds.py ADDRESS DOMAIN SIDE. Prints one line of JSON for each step; the hand may follow from the first on.
"""

import json
import sys
import time
from dataclasses import dataclass, is_dataclass
from xml.etree import ElementTree

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration


@dataclass
class Time_(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    sec: types.int32
    nanosec: types.uint32


@dataclass
class Duration_(IdlStruct, typename="builtin_interfaces.msg.dds_.Duration_"):
    sec: types.int32
    nanosec: types.uint32


@dataclass
class Header_(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    stamp: Time_
    frame_id: str


@dataclass
class String_(IdlStruct, typename="std_msgs.msg.dds_.String_"):
    data: str


@dataclass
class JointState_(IdlStruct, typename="sensor_msgs.msg.dds_.JointState_"):
    header: Header_
    name: types.sequence[str]
    position: types.sequence[types.float64]
    velocity: types.sequence[types.float64]
    effort: types.sequence[types.float64]


@dataclass
class JointTrajectoryPoint_(IdlStruct, typename="trajectory_msgs.msg.dds_.JointTrajectoryPoint_"):
    positions: types.sequence[types.float64]
    velocities: types.sequence[types.float64]
    accelerations: types.sequence[types.float64]
    effort: types.sequence[types.float64]
    time_from_start: Duration_


@dataclass
class JointTrajectory_(IdlStruct, typename="trajectory_msgs.msg.dds_.JointTrajectory_"):
    header: Header_
    joint_names: types.sequence[str]
    points: types.sequence[JointTrajectoryPoint_]


@dataclass
class Vector3_(IdlStruct, typename="geometry_msgs.msg.dds_.Vector3_"):
    x: types.float64
    y: types.float64
    z: types.float64


@dataclass
class Quaternion_(IdlStruct, typename="geometry_msgs.msg.dds_.Quaternion_"):
    x: types.float64
    y: types.float64
    z: types.float64
    w: types.float64


@dataclass
class Transform_(IdlStruct, typename="geometry_msgs.msg.dds_.Transform_"):
    translation: Vector3_
    rotation: Quaternion_


@dataclass
class TransformStamped_(IdlStruct, typename="geometry_msgs.msg.dds_.TransformStamped_"):
    header: Header_
    child_frame_id: str
    transform: Transform_


@dataclass
class TFMessage_(IdlStruct, typename="tf2_msgs.msg.dds_.TFMessage_"):
    transforms: types.sequence[TransformStamped_]


CONFIG = """<CycloneDDS><Domain Id="any"><General><Interfaces>
<NetworkInterface address="{}" priority="default" multicast="default"/>
</Interfaces></General></Domain></CycloneDDS>"""
address, domain, side = sys.argv[1], int(sys.argv[2]), sys.argv[3]
config = Domain(domain, CONFIG.format(address))
participant = DomainParticipant(domain)
# As ROS 2 has it by default, and as RViz asks for what is kept for it.
RELIABLE = Policy.Reliability.Reliable(duration(seconds=1))
LASTING = (RELIABLE, Policy.Durability.TransientLocal)


def reader(name, kind, *more):
    return DataReader(participant, Topic(participant, name, kind), Qos(Policy.History.KeepLast(100), *more))


def heard(of):
    """The next message that waits. What tells only that its writer is gone is none."""
    return next((sample for sample in of.take(1) if is_dataclass(sample)), None)


def wait(wanted, within=20):
    until = time.monotonic() + within
    while time.monotonic() < until:
        if found := wanted():
            return found
        time.sleep(0.001)
    sys.exit("nothing came in time")


def tell(**words):
    print(json.dumps(words), flush=True)


joints, frames = reader("rt/joint_states", JointState_, RELIABLE), reader("rt/tf", TFMessage_, RELIABLE)
wait(lambda: heard(joints))
moving = wait(lambda: heard(frames)).transforms
# They ask late, and what was sent before comes nevertheless.
models = reader("rt/robot_description", String_, *LASTING)
model = ElementTree.fromstring(wait(lambda: heard(models)).data)
kept = reader("rt/tf_static", TFMessage_, *LASTING)
fixed = wait(lambda: heard(kept)).transforms
links = {link.get("name") for link in model.iter("link")}
children = {frame.child_frame_id for frame in [*moving, *fixed]}
assert children | {f"{side}_palm"} == links, children ^ links
tell(frames=len(moving), fixed=len(fixed), links=len(links))

trajectories = DataWriter(
    participant, Topic(participant, f"rt/handscope/{side}/joint_trajectory", JointTrajectory_), Qos(RELIABLE)
)
positions = DataWriter(participant, Topic(participant, f"rt/handscope/{side}/joint_command", JointState_), Qos(RELIABLE))
index, follower = f"{side}_index_1_joint", f"{side}_index_2_joint"
header = Header_(Time_(0, 0), "")


def at_index(state):
    return state.position[state.name.index(index)]


def send(write, target):
    """Sends a target fifty times a second until the finger is there."""
    until, pose = time.monotonic() + 20, None
    while time.monotonic() < until:
        write()
        time.sleep(0.02)
        while sample := heard(joints):
            pose = sample
        if pose and abs(at_index(pose) - target) < 0.03:
            return at_index(pose)
    sys.exit(f"the finger is at {pose and at_index(pose)}, not at {target}")


def point(target, millis):
    return JointTrajectoryPoint_([target], [], [], [], Duration_(0, millis * 1_000_000))


def trajectory(*points):
    trajectories.write(JointTrajectory_(header, [index], list(points)))


tell(trajectory=send(lambda: trajectory(point(0.7, 34)), 0.7))
# The same program goes on with the other topic once the first was silent for a second.
trajectory(point(0.7, 900))
trajectory(point(0.7, 0), point(0.8, 50))
time.sleep(1.5)
state = JointState_(header, [index, follower], [0.3, 0.3 * 1.0843], [], [])
tell(positions=send(lambda: positions.write(state), 0.3))
until = time.monotonic() + 0.5
while time.monotonic() < until:
    positions.write(state)
    time.sleep(0.02)
trajectory()
tell(stopped=True)
time.sleep(1)

"""The workspace of `handscope ros2` and a bag of `export --rosbag`, read by programs that are not ours: the messages of the package
decode the bag, and a chain of its frames ends where the model's fingertips are.

Usage: ros2_workspace.py WORKSPACE BAG. The launch file is compiled, but not run: there is no ROS here.
"""

import math
import pathlib
import sys
from xml.etree import ElementTree

from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

workspace, bag = map(pathlib.Path, sys.argv[1:3])

# A ROS 2 that knows only its own types and those of the package.
store = get_typestore(Stores.ROS2_HUMBLE)
messages = sorted((workspace / "src/handscope_msgs/msg").glob("*.msg"))
for path in messages:
    store.register(get_types_from_msg(path.read_text(), f"handscope_msgs/msg/{path.stem}"))
listed = (workspace / "src/handscope_msgs/CMakeLists.txt").read_text()
assert messages and all(f'"msg/{path.name}"' in listed for path in messages), listed

topics, latched = {}, set()
with AnyReader([bag]) as reader:
    for connection, nanos, raw in reader.messages():
        message = store.deserialize_cdr(raw, connection.msgtype)
        topics.setdefault(connection.topic, []).append((nanos, message))
        # What ROS 2 itself has under that name has the same fields as ours.
        assert bytes(store.serialize_cdr(message, connection.msgtype)) == bytes(raw), connection.topic
    for connection in reader.connections:
        if any(own.durability == QosDurability.TRANSIENT_LOCAL for own in connection.ext.offered_qos_profiles):
            latched.add(connection.topic)
assert latched == {"/robot_description", "/tf_static"}, latched
ours = [topic for topic in topics if topic.startswith("/handscope/")]
assert len(ours) > 7, ours

description = topics["/robot_description"][0][1].data
side = "left" if "left_palm" in description else "right"
written = (workspace / f"src/handscope_bringup/urdf/ftp_{side}_hand.urdf").read_text()
assert description == written, "the bag and the package have another model"
links = {link.get("name") for link in ElementTree.fromstring(description).iter("link")}


def product(one, two):
    (a, b, c, d), (e, f, g, h) = one, two
    return (
        d * e + a * h + b * g - c * f,
        d * f - a * g + b * h + c * e,
        d * g + a * f - b * e + c * h,
        d * h - a * e - b * f - c * g,
    )


def turned(turn, at):
    x, y, z, w = turn
    return product(product(turn, (*at, 0.0)), (-x, -y, -z, w))[:3]


fixed = topics["/tf_static"][0][1].transforms
states = dict(topics["/joint_states"])
furthest = 0.0
for nanos, message in topics["/tf"]:
    frames = {frame.child_frame_id: frame for frame in [*message.transforms, *fixed]}
    assert set(frames) | {f"{side}_palm"} == links, links ^ set(frames)
    for name in frames:
        at, steps = (0.0, 0.0, 0.0), 0
        while name != f"{side}_palm":
            pose = frames[name].transform
            turn = (pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w)
            assert abs(math.hypot(*turn) - 1) < 1e-5, turn
            moved = turned(turn, at)
            at = tuple(a + b for a, b in zip(moved, (pose.translation.x, pose.translation.y, pose.translation.z)))
            name, steps = frames[name].header.frame_id, steps + 1
            assert steps < 6
        furthest = max(furthest, math.hypot(*at))
    assert nanos in states, "frames have the time of a state of the joints"
assert 0.15 < furthest < 0.27, furthest
launch = workspace / "src/handscope_bringup/launch/hand.launch.py"
compile(launch.read_text(), launch.name, "exec")
print(f"rosbags decodes {len(topics)} topics by {len(messages)} messages of the package; {len(topics['/tf'])} sets of frames are whole")

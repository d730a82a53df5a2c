"""A shared hand as a viewer sees it that we did not write: the WebSockets of `websockets`, the messages decoded with
mcap-ros2-support and with rosbags from nothing but the definitions that are told. Usage: foxglove.py HOST:PORT"""
import asyncio
import json
import struct
import sys

import websockets
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


async def view(subprotocol):
    place = f"ws://{sys.argv[1]}"
    async with websockets.connect(place, subprotocols=[subprotocol], open_timeout=20) as socket:
        assert socket.subprotocol == subprotocol, socket.subprotocol
        info, told = json.loads(await socket.recv()), json.loads(await socket.recv())
        assert info["op"] == "serverInfo" and info["capabilities"] == [], info
        assert told["op"] == "advertise", told
        channels = {channel["id"]: channel for channel in told["channels"]}
        wanted = [{"id": 1000 + number, "channelId": number} for number in channels]
        await socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
        seen = {}
        while min(len(seen.get(name, [])) for name in WANTED) < 20:
            data = await asyncio.wait_for(socket.recv(), 20)
            opcode, number, nanos = struct.unpack_from("<BIQ", data)
            assert opcode == 1, opcode
            channel = channels[number - 1000]
            assert (channel["encoding"], channel["schemaEncoding"]) == ("cdr", "ros2msg"), channel
            seen.setdefault(channel["topic"], []).append((channel, nanos, data[13:]))
        return info, seen


FINGERS = ["little", "ring", "middle", "index", "thumb"]
WANTED = ["/joint_states", "/handscope/state", "/handscope/wire"] + [f"/handscope/touch/{finger}" for finger in FINGERS]


def by_mcap(channel, data):
    schema = Schema(id=1, name=channel["schemaName"], encoding=channel["schemaEncoding"], data=channel["schema"].encode())
    return DecoderFactory().decoder_for(channel["encoding"], schema)(data)


def by_rosbags(channel, data):
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(channel["schema"], channel["schemaName"]))
    return store.deserialize_cdr(data, channel["schemaName"])


for subprotocol in ["foxglove.sdk.v1", "foxglove.websocket.v1"]:
    info, seen = asyncio.run(view(subprotocol))
    for decode in [by_mcap, by_rosbags]:
        channel, nanos, data = seen["/joint_states"][0]
        joints = decode(channel, data)
        stamp = joints.header.stamp.sec * 10**9 + joints.header.stamp.nanosec
        assert len(joints.name) == len(joints.position) == 12 and stamp == nanos, joints
        # A message has what one reply brought, so not each has the angles.
        states = [decode(channel, data) for channel, _, data in seen["/handscope/state"]]
        angles = [list(state.angle) for state in states if len(state.angle)]
        assert angles and all(six == [1000] * 6 for six in angles), states
        channel, _, data = seen["/handscope/touch/index"][0]
        assert len(decode(channel, data).raw) == 58
        for topic, messages in seen.items():
            decode(messages[0][0], messages[0][2])
    times = [nanos for _, nanos, _ in seen["/handscope/state"]]
    assert times == sorted(times) and len(set(times)) == len(times), times
    print(subprotocol, info["name"], len(seen))

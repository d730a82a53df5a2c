"""A session as programs see it that we did not write: mcap with mcap-ros2-support, rosbags, pyarrow with pandas. The values of all of
them are compared with our CSV. Usage: sessions.py FOLDER, which holds session.mcap, session.csv, session.parquet and bag/"""
import json
import math
import pathlib
import sys

import pandas as pd
import polars as pl
import pyarrow.parquet as pq
from mcap_ros2.reader import read_ros2_messages
from rosbags.highlevel import AnyReader

JOINTS = ["little", "ring", "middle", "index", "thumb_bend", "thumb_rotate"]
FINGERS = ["little", "ring", "middle", "index", "thumb"]
folder = pathlib.Path(sys.argv[1])
csv = pd.read_csv(folder / "session.csv")
assert csv["time_s"].is_monotonic_increasing and list(csv.columns[-2:]) == ["undocumented", "event"]


def column(table, name):
    return table[name].dropna().tolist()


def same(ours, theirs, what):
    assert len(ours) == len(theirs) > 50, (what, len(ours), len(theirs))
    for one, two in zip(ours, theirs):
        assert math.isclose(one, two, rel_tol=1e-6, abs_tol=1e-6), (what, one, two)


def check(states, touches, who):
    for place, joint in enumerate(JOINTS):
        angles = [state.angle[place] for state in states if len(state.angle) == 6]
        same(column(csv, f"angle_{joint}"), angles, f"{who}: angle of {joint}")
        forces = [state.force[place] for state in states if len(state.force) == 6]
        same(column(csv, f"force_{joint}_g"), forces, f"{who}: force of {joint}")
    for finger in FINGERS:
        blocks = touches[f"/handscope/touch/{finger}"]
        same(column(csv, f"normal_{finger}_N"), [block.normal_n for block in blocks], f"{who}: force at {finger}")
        same(column(csv, f"channel_1_{finger}"), [block.channels[0] for block in blocks], f"{who}: channel at {finger}")


def gathered(messages):
    topics = {}
    for topic, message in messages:
        topics.setdefault(topic, []).append(message)
    return topics


# mcap, message after message, with the definitions that stand in the file.
read = [(m.channel.topic, m.ros_msg) for m in read_ros2_messages(str(folder / "session.mcap"))]
topics = gathered(read)
check(topics["/handscope/state"], topics, "mcap-ros2-support")
joints = topics["/joint_states"]
assert len(joints[0].name) == len(joints[0].position) == 12, joints[0]
parameters = [event.words for event in topics["/handscope/event"] if event.kind == "parameters"]
assert len(parameters) == 1 and 'format = "handscope-params"' in parameters[0], parameters
print("mcap-ros2-support reads", len(read), "messages of", len(topics), "topics")

# The rosbag2 folder.
with AnyReader([folder / "bag"]) as bag:
    bagged = [(c.topic, bag.deserialize(raw, c.msgtype)) for c, _, raw in bag.messages()]
    assert len(bagged) == bag.message_count == len(read), (len(bagged), bag.message_count, len(read))
topics = gathered(bagged)
check(topics["/handscope/state"], topics, "rosbags")
print("rosbags reads", len(bagged), "messages")

# Parquet: a row is a reading, and what it did not bring is null.
file = pq.ParquetFile(folder / "session.parquet")
units = json.loads(file.schema_arrow.metadata[b"units"])
assert units["force_index_g"] == "g" and units["normal_thumb_N"] == "N" and "angle_index" not in units, units
for field in file.schema_arrow:
    unit = (field.metadata or {}).get(b"unit", b"").decode()
    assert unit == units.get(field.name, ""), field
assert file.schema_arrow.field("force_index_g").metadata[b"unit"] == b"g"
assert str(file.schema_arrow.field("received").type) == "timestamp[ns, tz=UTC]", file.schema_arrow
table = file.read().to_pandas()
for joint in JOINTS:
    for name in [f"angle_{joint}", f"force_{joint}_g", f"temperature_{joint}_C", f"target_angle_{joint}"]:
        ours = column(csv, name)
        theirs = column(table, name)
        assert ours == theirs and len(ours) > 0, (name, len(ours), len(theirs))
for finger in FINGERS:
    same(column(csv, f"tangential_{finger}_N"), column(table, f"tangential_{finger}_N"), f"parquet: {finger}")
assert table["received"].dt.tz is not None and (table["asked"] <= table["received"]).all()
start = table["received"].iloc[0] - pd.to_timedelta(table["time_s"].iloc[0], unit="s")
apart = (table["received"] - start).dt.total_seconds() - table["time_s"]
assert apart.abs().max() < 1e-5, apart.abs().max()
print("pyarrow and pandas", pd.__version__, "read", len(table), "rows of", len(table.columns), "columns")

# polars, as it reads without being told anything: no column of numbers is text, and nothing is refused.
frame = pl.read_csv(folder / "session.csv")
assert len(frame) == len(csv) and frame.columns == list(csv.columns)
for name in frame.columns[:-8]:
    theirs, ours = frame[name].drop_nulls().to_list(), column(csv, name)
    assert not theirs or frame[name].dtype.is_numeric(), (name, frame[name].dtype)
    assert theirs == ours, name
assert frame["grip"].drop_nulls().to_list() == column(csv, "grip") != []
parquet = pl.read_parquet(folder / "session.parquet")
assert parquet["force_index_g"].drop_nulls().to_list() == column(csv, "force_index_g")
print("polars", pl.__version__, "reads", len(frame), "lines and", len(parquet), "rows")

# What both write is imported again: see .ci/run, which compares what comes back.
csv.to_csv(folder / "pandas.csv")
frame.write_csv(folder / "polars.csv")

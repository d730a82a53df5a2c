"""A session that other programs have rewritten (the mcap library of Python, rosbags) still gives the same values: other numbers of
channels, another order, merged, filtered, in chunks or not, with each compression, with an index or without, or with a stale one.
Usage: rewritten.py HANDSCOPE FOLDER, which holds session.mcap, session.csv and bag/"""
import csv
import json
import pathlib
import struct
import subprocess
import sys

from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as BagWriter

handscope, folder = sys.argv[1], pathlib.Path(sys.argv[2])
wanted = list(csv.reader(open(folder / "session.csv")))
with open(folder / "session.mcap", "rb") as file:
    reader = make_reader(file)
    messages = list(reader.iter_messages(log_time_order=False))
    metadata = list(reader.iter_metadata())
assert len(messages) > 1000 and len(metadata) == 1, (len(messages), len(metadata))


def write(path, order=lambda all: all, halves=False, about=True, strangers=False, library="another", **options):
    """Writes the messages anew. Channels get numbers in the order in which their first message comes; two sets of them for halves."""
    with open(path, "wb") as file:
        writer = Writer(file, **options)
        writer.start(profile="ros2", library=library)
        schemas, channels = {}, {}
        if strangers:
            schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
            stranger = writer.register_channel("/chatter", "cdr", schema)
        for number, (schema, channel, message) in enumerate(order(messages)):
            half = halves and number * 2 >= len(messages)
            if (schema.name, half) not in schemas:
                schemas[schema.name, half] = writer.register_schema(schema.name, schema.encoding, schema.data)
            if (channel.topic, half) not in channels:
                schema_id = schemas[schema.name, half]
                channels[channel.topic, half] = writer.register_channel(channel.topic, channel.message_encoding, schema_id)
            writer.add_message(
                channels[channel.topic, half], message.log_time, message.data, message.publish_time, message.sequence
            )
            if strangers and number % 100 == 0:
                writer.add_message(stranger, message.log_time, b"\0\1\0\0\2\0\0\0a\0", message.log_time)
        if about:
            for record in metadata:
                writer.add_metadata(record.name, record.metadata)
        writer.finish()


def run(*args):
    done = subprocess.run([handscope, *map(str, args)], capture_output=True, text=True)
    assert done.returncode == 0, (args, done.stderr)
    return done.stdout


def check(what, path, same_start=True):
    out = path.with_suffix(".csv")
    run("export", path, "--csv", "--out", out)
    rows = list(csv.reader(open(out)))
    assert len(rows) == len(wanted), (what, len(rows), len(wanted))
    skip = 0 if same_start else 1  # without what the file said of itself, time counts from the first message
    for ours, theirs in zip(wanted, rows):
        assert ours[skip:] == theirs[skip:], (what, ours, theirs)
    told = json.loads(run("info", path, "--json"))
    assert told["damaged_chunks"] == told["damaged_bytes"] == told["missing_messages"] == 0, (what, told)
    assert told["hand"].startswith("sim:") and "scenario=grasp" in told["hand"] and told["simulated"] is True, (what, told)
    assert "nothing is missing" not in run("info", path), what
    print("read as before:", what)
    return told["remarks"]


def spliced(data, index, to):
    """The data of one file with the index of another, whose sum is left out."""
    magic = 8

    def behind(all):
        at = magic
        while all[at] != 15:
            at += 9 + struct.unpack_from("<Q", all, at + 1)[0]
        return at + 13

    data, index = data.read_bytes(), index.read_bytes()
    all = bytearray(data[: behind(data)])
    start = len(all)
    all += index[behind(index) :]
    footer = len(all) - magic - 20
    struct.pack_into("<Q", all, footer, start)
    struct.pack_into("<I", all, footer + 16, 0)
    to.write_bytes(all)


def by_time(all):
    return sorted(all, key=lambda one: one[2].log_time)


small = {"chunk_size": 20_000}
for what, options in {
    "as it is": {},
    "under our name": {"library": "handscope 0.1.0"},
    "zstd": {"compression": CompressionType.ZSTD},
    "lz4": {"compression": CompressionType.LZ4, **small},
    "not compressed": {"compression": CompressionType.NONE},
    "no chunks": {"use_chunking": False},
    "no chunks, backwards": {"use_chunking": False, "order": lambda all: all[::-1]},
    "by time": {"order": by_time, **small},
    "backwards": {"order": lambda all: by_time(all)[::-1], **small},
    "topic after topic": {"order": lambda all: sorted(all, key=lambda one: one[1].topic), **small},
    "two sets of channels": {"halves": True, **small},
    "no index": {
        "index_types": IndexType.NONE,
        "repeat_channels": False,
        "repeat_schemas": False,
        "use_statistics": False,
        "use_summary_offsets": False,
    },
    "no sums": {"enable_crcs": False},
    "one chunk": {"chunk_size": 1 << 40},
    "with strangers": {"strangers": True},
}.items():
    path = folder / f"rewritten {what}.mcap"
    write(path, **options)
    remarks = check(what, path)
    assert any("another program" in remark for remark in remarks), remarks
    named = [remark for remark in remarks if "/chatter" in remark]
    assert len(named) == (what == "with strangers"), remarks

# Without what the file says of itself.
path = folder / "rewritten bare.mcap"
write(path, about=False)
assert any("description in the file" in remark for remark in check("nothing about itself", path, same_start=False))

# Fingertips filtered out: what is left is the same, and nobody says that nothing is missing.
path = folder / "rewritten filtered.mcap"
write(path, order=lambda all: [one for one in all if "touch" not in one[1].topic])
run("export", path, "--csv", "--out", path.with_suffix(".csv"))
left = list(csv.DictReader(open(path.with_suffix(".csv"))))
before = list(csv.DictReader(open(folder / "session.csv")))
for name in ["angle_index", "force_thumb_bend_g"]:
    values = [[row[name] for row in rows if row[name]] for rows in (left, before)]
    assert values[0] == values[1] and values[0], name
assert not any(row["normal_thumb_N"] for row in left)
assert "nothing is missing" not in run("info", path)

# An index of other data.
write(folder / "rewritten whole.mcap", **small)
write(folder / "rewritten half.mcap", order=lambda all: all[: len(all) // 2], **small)
path = folder / "rewritten stale.mcap"
spliced(folder / "rewritten whole.mcap", folder / "rewritten half.mcap", path)
assert any("index does not match" in remark for remark in check("a stale index", path)), path

# rosbags, which writes its own text of each definition.
with AnyReader([folder / "bag"]) as bag, BagWriter(folder / "rebagged", version=9, storage_plugin=StoragePlugin.MCAP) as writer:
    made = {}
    for connection, time, raw in bag.messages():
        if connection.topic not in made:
            made[connection.topic] = writer.add_connection(connection.topic, connection.msgtype, typestore=bag.typestore)
        writer.write(made[connection.topic], time, raw)
(path,) = (folder / "rebagged").glob("*.mcap")
check("rosbags", path, same_start=False)

"""A LeRobot v3.0 data set read as LeRobot's own reader does it: data through datasets with the features of info.json, episodes and
tasks through datasets and pandas. Values are compared with our CSV. Usage: lerobot.py FOLDER, which holds set/ and session.csv"""
import json
import pathlib
import sys

import datasets
import numpy as np
import pandas as pd

folder = pathlib.Path(sys.argv[1])
root = folder / "set"
info = json.loads((root / "meta/info.json").read_text())
stats = json.loads((root / "meta/stats.json").read_text())


def feature(kind):
    value = datasets.Value(kind["dtype"])
    return value if kind["shape"] == [1] else datasets.Sequence(value, length=kind["shape"][0])


assert info["codebase_version"] == "v3.0" and info["video_path"] is None
features = datasets.Features({name: feature(kind) for name, kind in info["features"].items()})
paths = [str(path) for path in sorted(root.glob("data/*/*.parquet"))]
named = info["data_path"].format(chunk_index=0, file_index=0)
assert paths == [str(root / named)], paths
data = datasets.Dataset.from_parquet(paths, features=features, cache_dir=str(folder / "cache"))
assert len(data) == info["total_frames"] > 50

tasks = pd.read_parquet(root / "meta/tasks.parquet")
assert tasks.iloc[0].name == "grasp" and tasks.loc["grasp"].task_index == 0, tasks
episodes = [str(path) for path in sorted(root.glob("meta/episodes/*/*.parquet"))]
episodes = datasets.Dataset.from_parquet(episodes, cache_dir=str(folder / "cache"))
assert len(episodes) == info["total_episodes"] >= 2
assert info["splits"]["train"] == f"0:{len(episodes)}"

table = data.to_pandas()
assert table["index"].tolist() == list(range(len(table))) and set(table["task_index"]) == {0}
for number, episode in enumerate(episodes):
    begin, end = episode["dataset_from_index"], episode["dataset_to_index"]
    part = table.iloc[begin:end]
    assert episode["episode_index"] == number and episode["length"] == len(part) == end - begin
    assert episode["tasks"] == ["grasp"] and set(part["episode_index"]) == {number}
    assert part["frame_index"].tolist() == list(range(len(part)))
    assert np.allclose(part["timestamp"], part["frame_index"] / info["fps"], atol=1e-4)
assert episodes[-1]["dataset_to_index"] == len(table)

csv = pd.read_csv(folder / "session.csv")
joints = ["little", "ring", "middle", "index", "thumb_bend", "thumb_rotate"]
angles = csv[[f"angle_{joint}" for joint in joints]].dropna().to_numpy() / 1000
state = np.stack(table["observation.state"].to_list())
assert all((np.abs(angles - row).max(axis=1) < 1e-6).any() for row in state), "every frame is a reading"
assert 0 <= state.min() and state.max() <= 1 and state.shape[1] == len(info["features"]["observation.state"]["names"])
parts = ["observation.force", "observation.touch"]
both = np.concatenate([np.stack(table[name].to_list()) for name in parts], axis=1)
assert (np.stack(table["observation.environment_state"].to_list()) == both).all(), "the same, where policies look"
assert len(info["features"]["observation.environment_state"]["names"]) == both.shape[1] == 16
for name in ["observation.state", "action", "observation.environment_state", *parts]:
    values = np.stack(table[name].to_list()).astype(float)
    theirs = stats[name]
    for key, ours in [("min", values.min(0)), ("max", values.max(0)), ("mean", values.mean(0)), ("std", values.std(0))]:
        assert np.allclose(ours, theirs[key], rtol=1e-4, atol=1e-4), (name, key)
    assert np.allclose(np.quantile(values, 0.5, axis=0), theirs["q50"], atol=0.51 * (values.max() - values.min()) + 1e-9)
    assert theirs["count"] == [len(values)] and {"q01", "q10", "q90", "q99"} <= theirs.keys()
print("datasets", datasets.__version__, "reads", len(table), "frames in", len(episodes), "episodes")

"""A session of trials as pandas reads it, with the lines of the manual (assets/manual/files.md). Usage: pandas_trials.py FOLDER"""
import sys

place = sys.argv[1]

import pathlib, tomllib, pandas as pd
folder = pathlib.Path(place)
session = tomllib.loads((folder / "session.toml").read_text())
metrics = pd.json_normalize(session["trial"], "joint", ["number", "speed", "force_threshold_g"])
samples = {t["number"]: pd.read_csv(folder / t["samples"]) for t in session["trial"]}

assert len(samples) == len(session["trial"]) >= 2, len(samples)
assert set(metrics["joint"]) == {"index"}, metrics
assert (metrics["overshoot_g"] > -50).all(), metrics
for number, table in samples.items():
    assert table["time_s"].is_monotonic_increasing
    assert table["time_s"].min() < -0.4, "from before the command"
    force = table[["time_s", "force_g_index"]].dropna()
    assert len(force) > 50 and force["force_g_index"].dtype.kind == "f"
    close = table.loc[table["event"] == "close", "time_s"]
    assert close.tolist() == [0.0]
    row = metrics[metrics["number"] == number].iloc[0]
    held = force[(force["time_s"] > 0)]
    peak = held["force_g_index"].max() - row["rest_force_g"]
    assert abs(peak - row["peak_force_g"]) < 1, (peak, row["peak_force_g"])
print(metrics[["number", "speed", "force_threshold_g", "overshoot_g", "steady_force_g"]].to_string(index=False))
print("pandas", pd.__version__, "reads", len(samples), "trials")

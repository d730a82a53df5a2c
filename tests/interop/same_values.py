"""Two tables of ours hold the same values and events. Usage: same_values.py ONE.csv OTHER.csv"""
import sys

import pandas as pd

one, other = (pd.read_csv(path) for path in sys.argv[1:])
# The grip rests on the status, which no table of values has.
one, other = (table[[name for name in table if name.split("_")[0] != "grip"]] for table in (one, other))
# A line on which nothing was received that has a column tells nothing, and is not made again.
one = one[one.drop(columns="time_s").notna().any(axis=1)].reset_index(drop=True)
pd.testing.assert_frame_equal(one, other, check_dtype=False)
print("the same", len(one), "lines")

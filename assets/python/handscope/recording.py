"""Recordings as tables."""

from __future__ import annotations

import importlib
import json
import os
import tempfile
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Tuple, Union

from . import program
from .errors import HandscopeError

if TYPE_CHECKING:
    import pandas

Path = Union[str, "os.PathLike[str]"]


def read(path: Path, start_s: Optional[float] = None, end_s: Optional[float] = None) -> "pandas.DataFrame":
    """A recording as a DataFrame with a row a reading, by its time in UTC, or a stretch of it: `force_index_g`,
    `normal_thumb_N`, ..., as `handscope export --parquet` has it (`handscope help sessions`). What was not read in a row is
    missing. `attrs` has `hand`, `simulated`, `start` (seconds since 1970) and the `units` of the columns."""
    table, about = _table(path, start_s, end_s)
    frame: "pandas.DataFrame" = table.to_pandas().set_index("received")
    seconds = frame["time_s"].iloc[:1].sum()
    start = frame.index[0].timestamp() - float(seconds) if len(frame) else None
    frame.attrs = {**about["session"], "start": start, "units": about["units"]}
    return frame


def events(path: Path, start_s: Optional[float] = None, end_s: Optional[float] = None) -> List[Mapping[str, Any]]:
    """What happened in a recording, each with `time_s`, `kind` and `words`: notes, stops, faults, lost links, ..."""
    found: List[Mapping[str, Any]] = _table(path, start_s, end_s)[1]["events"]
    return found


def _table(path: Path, start_s: Optional[float], end_s: Optional[float]) -> Tuple[Any, Dict[str, Any]]:
    """The recording as a table of pyarrow, and what it says about itself."""
    try:
        importlib.import_module("pandas")
        parquet = importlib.import_module("pyarrow.parquet")
    except ImportError:
        raise HandscopeError("reading a recording needs pandas and pyarrow: 'pip install pandas pyarrow'") from None
    stretch = [] if start_s is None else ["--from", str(start_s)]
    stretch += [] if end_s is None else ["--to", str(end_s)]
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "recording.parquet")
        done = program.run(["export", os.fspath(path), *stretch, "--parquet", "--out", out])
        if done.why:
            raise HandscopeError(done.why)
        table = parquet.read_table(out, memory_map=False)
    told = table.schema.metadata
    return table, {name: json.loads(told[name.encode()]) for name in ("units", "session", "events")}

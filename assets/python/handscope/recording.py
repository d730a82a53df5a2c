"""Recordings as tables."""

from __future__ import annotations

import os
import tempfile
from typing import TYPE_CHECKING, Optional, Union

from . import program
from .errors import HandscopeError

if TYPE_CHECKING:
    import pandas


def read(
    path: Union[str, "os.PathLike[str]"], start_s: Optional[float] = None, end_s: Optional[float] = None
) -> "pandas.DataFrame":
    """A recording as a DataFrame with a row a reading, or a stretch of it: `force_index_g`, `normal_thumb_N`, ..., as
    `handscope export --csv` has it (`handscope help sessions`). What was not read in a row is NaN."""
    try:
        import pandas
    except ImportError:
        raise HandscopeError("reading a recording needs pandas: 'pip install pandas'") from None
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "recording.csv")
        stretch = []
        if start_s is not None:
            stretch += ["--from", str(start_s)]
        if end_s is not None:
            stretch += ["--to", str(end_s)]
        done = program.run(["export", os.fspath(path), *stretch, "--csv", "--out", table])
        if done.why:
            raise HandscopeError(done.why)
        return pandas.read_csv(table, low_memory=False)

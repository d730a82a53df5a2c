"""The FTP series tactile hand: `handscope.open("sim:")` gives a hand, `handscope.read("grasp.mcap")` a recording.

The manual is `handscope help python`.
"""

from __future__ import annotations

from importlib import metadata as _metadata

from .errors import Disarmed, HandscopeError, LinkLost, NotArmed, ProgramNotFound, Refused, Taken
from .hand import Hand, Motion, Recording, States, hands
from .recording import events, read
from .state import FINGERS, JOINTS, Check, Finger, Grip, GripResult, Gripped, GripState, Joint, MoveEnd, State, Touch, Trial, Tune

__all__ = [
    "FINGERS", "JOINTS", "Check", "Disarmed", "Finger", "Grip", "GripResult", "GripState", "Gripped", "Hand", "HandscopeError",
    "Joint", "LinkLost", "Motion", "MoveEnd", "NotArmed", "ProgramNotFound", "Recording", "Refused", "State", "States", "Taken",
    "Touch", "Trial", "Tune", "events", "hands", "open", "read",
]  # fmt: skip

try:
    __version__ = _metadata.version("handscope")
except _metadata.PackageNotFoundError:
    __version__ = "0+source"


def open(url: str, *, hz: float = 100.0, side: str = "right", port: int = 0, writers: bool = True) -> Hand:
    """Opens a hand, such as `sim:` or `tcp:192.168.11.210` (`handscope help hands`), and shares it on this computer.
    Nothing moves. `hz` is how often it is read; `port` where it is shared, any free one if 0. Without `writers` no other program
    can move the hand, the window of `show()` and the commands (`trial`, `tune`, ...) included."""
    return Hand(url, hz, side, port, writers)

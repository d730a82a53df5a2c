"""The FTP series tactile hand: `handscope.open("sim:")` gives a hand, `handscope.read("grasp.mcap")` a recording.

The manual is `handscope help python`.
"""

from __future__ import annotations

from .errors import Disarmed, HandscopeError, LinkLost, NotArmed, ProgramNotFound, Refused, Taken
from .hand import Hand, Recording, States
from .recording import read
from .state import FINGERS, JOINTS, Grip, GripResult, State, Touch

__all__ = [
    "FINGERS", "JOINTS", "Disarmed", "Grip", "GripResult", "Hand", "HandscopeError", "LinkLost", "NotArmed",
    "ProgramNotFound", "Recording", "Refused", "State", "States", "Taken", "Touch", "open", "read",
]  # fmt: skip


def open(url: str, *, hz: float = 100.0, side: str = "right", port: int = 0) -> Hand:
    """Opens a hand, such as `sim:` or `tcp:192.168.11.210` (`handscope help hands`), and shares it on this computer.
    Nothing moves. `hz` is how often it is read; `port` where it is shared, any free one if 0."""
    return Hand(url, hz, side, port)

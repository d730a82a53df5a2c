"""What the hand says, as values. Unknown is `None`, never zero."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any, Dict, List, Mapping, Optional

JOINTS = ("little", "ring", "middle", "index", "thumb_bend", "thumb_rotate")
"""The six joints in the hand's own order."""

FINGERS = ("little", "ring", "middle", "index", "thumb")
"""The five fingers in the hand's own order."""

Joints = Dict[str, Optional[int]]
"""A value of each joint, by its name."""


@dataclass(frozen=True)
class Touch:
    """One fingertip."""

    normal_n: Optional[float]
    """Force into the fingertip, N."""
    tangential_n: Optional[float]
    """Force along it, N."""
    direction_deg: Optional[float]
    """Where that points."""
    proximity: Optional[int]
    """Counts of the proximity channel."""
    raw: Optional[List[int]]
    """The eight channels."""


@dataclass(frozen=True)
class Grip:
    """What the hand does to an object: `open`, `moving`, `empty`, `holding`, `slipping`, `lost`, `too_hard`, `unknown`."""

    state: str
    fingers: Mapping[str, str]
    """The same of each finger."""

    @property
    def holding(self) -> bool:
        """True if something is held and stays where it is."""
        return self.state == "holding"

    @property
    def empty(self) -> bool:
        """True if the hand closed on nothing."""
        return self.state == "empty"

    @classmethod
    def _of(cls, told: Mapping[str, Any]) -> "Grip":
        return cls(told["state"], {one["finger"]: one["state"] for one in told["fingers"]})


@dataclass(frozen=True)
class GripResult(Grip):
    """What a motion came to."""

    end: str
    """`reached`; `stopped`: at rest elsewhere, by an object or a force threshold; `late`: it took too long, and was stopped."""

    @classmethod
    def _done(cls, told: Mapping[str, Any]) -> "GripResult":
        grip = Grip._of(told["grip"])
        return cls(grip.state, grip.fingers, told["end"])


@dataclass(frozen=True)
class State:
    """One reading of the hand."""

    t_s: float
    """Seconds since the program was started."""
    angle: Joints
    """Counts: 0 bent, 1000 open."""
    force_g: Joints
    current_ma: Joints
    temp_c: Joints
    status: Dict[str, Optional[str]]
    faults: Dict[str, Optional[List[str]]]
    touch: Dict[str, Touch]
    grip: Grip
    lost: int
    """States that were left out directly before this one, because they were not read in time."""
    raw: Mapping[str, Any] = field(repr=False)
    """All that the program tells, as `handscope help json` has it under `watch`."""
    received: float = field(repr=False)
    """When it came, by `time.monotonic()`."""

    @property
    def age_s(self) -> float:
        """Seconds since it came."""
        return time.monotonic() - self.received

    @classmethod
    def _of(cls, told: Mapping[str, Any], lost: int) -> "State":
        def six(name: str) -> Dict[str, Any]:
            return dict(zip(JOINTS, told.get(name) or [None] * len(JOINTS)))

        touch = {
            tip["finger"]: Touch(tip["normal_n"], tip["tangential_n"], tip["direction_deg"], tip["proximity"], tip["raw"])
            for tip in told["tactile"]
        }
        return cls(
            t_s=told["t_s"],
            angle=six("angle"),
            force_g=six("force_g"),
            current_ma=six("current_ma"),
            temp_c=six("temp_c"),
            status=six("status"),
            faults=six("faults"),
            touch=touch,
            grip=Grip._of(told["grip"]),
            lost=lost,
            raw=told,
            received=time.monotonic(),
        )

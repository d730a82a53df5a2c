"""What the hand says, as values. Unknown, and outside the ranges of the hand's manual, is `None`, never zero."""

from __future__ import annotations

import time
from dataclasses import dataclass, fields
from typing import Any, Dict, List, Literal, Mapping, Optional, Tuple, cast

Joint = Literal["little", "ring", "middle", "index", "thumb_bend", "thumb_rotate"]
Finger = Literal["little", "ring", "middle", "index", "thumb"]
GripState = Literal["unknown", "open", "moving", "empty", "holding", "slipping", "lost", "too_hard"]
MoveEnd = Literal["reached", "stopped", "late"]

JOINTS: Tuple[Joint, ...] = ("little", "ring", "middle", "index", "thumb_bend", "thumb_rotate")
"""The six joints in the hand's own order."""

FINGERS: Tuple[Finger, ...] = ("little", "ring", "middle", "index", "thumb")
"""The five fingers in the hand's own order."""

Joints = Dict[Joint, Optional[int]]
"""A value of each joint, by its name."""


class _Value:
    """A value of `__slots__`, which a frozen dataclass cannot be copied as without this."""

    __slots__ = ()

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), tuple(getattr(self, one.name) for one in fields(cast(Any, self)))


@dataclass(frozen=True)
class Touch(_Value):
    """One fingertip."""

    __slots__ = ("normal_n", "tangential_n", "direction_deg", "proximity", "raw")

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
class Grip(_Value):
    """What the hand does to an object."""

    __slots__ = ("state", "fingers")

    state: GripState
    fingers: Mapping[Finger, GripState]
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

    __slots__ = ("end",)

    end: MoveEnd
    """`reached`; `stopped`: at rest elsewhere, by an object or a force threshold; `late`: it took too long, and was stopped."""

    @classmethod
    def _done(cls, told: Mapping[str, Any]) -> "GripResult":
        grip = Grip._of(told["grip"])
        return cls(grip.state, grip.fingers, told["end"])


@dataclass(frozen=True, repr=False)
class State(_Value):
    """One reading of the hand."""

    __slots__ = (
        "t_s", "time", "angle", "angle_rad", "force_g", "force_n", "current_ma", "temp_c", "status", "faults", "touch", "grip",
        "target", "speed", "threshold_g", "undocumented", "lost", "raw", "received",
    )  # fmt: skip

    t_s: float
    """Seconds since the program was started."""
    time: float
    """The same by this computer's clock, as `time.time()` gives it, if that was not set since."""
    angle: Joints
    """Counts: 0 bent, 1000 open."""
    angle_rad: Dict[Joint, Optional[float]]
    """The same as the driven joints of the URDF turn: 0 open."""
    force_g: Joints
    force_n: Dict[Joint, Optional[float]]
    """The same in newtons, of the joints that were measured on a scale (`handscope help scale`)."""
    current_ma: Joints
    temp_c: Joints
    status: Dict[Joint, Optional[str]]
    faults: Dict[Joint, Optional[List[str]]]
    touch: Dict[Finger, Touch]
    grip: Grip
    target: Joints
    """Angles that the hand was told, counts; `None` for a joint without one."""
    speed: Joints
    """Speeds that the hand was told, 0 to 1000."""
    threshold_g: Joints
    """Force thresholds that the hand was told."""
    undocumented: Dict[Tuple[str, str], Optional[float]]
    """Numbers outside the manual's ranges, in whose place is `None`: `{("angle", "index"): 32767}`."""
    lost: int
    """States that were left out directly before this one, because they were not read in time."""
    raw: Mapping[str, Any]
    """All that the program tells, as `handscope help json` has it under `watch`."""
    received: float
    """When it came, by `time.monotonic()`."""

    @property
    def age_s(self) -> float:
        """Seconds since it came."""
        return time.monotonic() - self.received

    def __repr__(self) -> str:
        shown = (f"{name}={getattr(self, name)!r}" for name in self.__slots__ if name not in ("raw", "received"))
        return f"State({', '.join(shown)})"

    @classmethod
    def _of(cls, told: Mapping[str, Any], lost: int, began: float) -> "State":
        def six(name: str) -> Dict[str, Any]:
            return dict(zip(JOINTS, told.get(name) or [None] * len(JOINTS)))

        asked = {"target": "target_angle", "speed": "target_speed", "threshold_g": "force_threshold_g"}
        same = ("angle", "angle_rad", "force_g", "force_n", "current_ma", "temp_c", "status", "faults")
        joints: Dict[str, Any] = {name: six(field) for name, field in {**dict(zip(same, same)), **asked}.items()}
        return cls(
            **joints,
            t_s=told["t_s"],
            time=began + told["t_s"],
            touch={tip["finger"]: Touch(**{name: tip[name] for name in Touch.__slots__}) for tip in told["tactile"]},
            grip=Grip._of(told["grip"]),
            undocumented={(one["field"], one.get("joint") or one["finger"]): one["raw"] for one in told["undocumented"]},
            lost=lost,
            raw=told,
            received=time.monotonic(),
        )

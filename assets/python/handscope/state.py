"""What the hand says, as values. Unknown, and outside the ranges of the hand's manual, is `None`, never zero."""

from __future__ import annotations

import time
from dataclasses import dataclass, fields
from typing import Any, Dict, List, Literal, Mapping, Optional, Tuple, TypedDict, cast

Joint = Literal["little", "ring", "middle", "index", "thumb_bend", "thumb_rotate"]
Finger = Literal["little", "ring", "middle", "index", "thumb"]
GripState = Literal["unknown", "open", "moving", "empty", "holding", "slipping", "lost", "too_hard", "touching"]
MoveEnd = Literal["reached", "stopped", "late"]

JOINTS: Tuple[Joint, ...] = ("little", "ring", "middle", "index", "thumb_bend", "thumb_rotate")
"""The six joints in the hand's own order."""

FINGERS: Tuple[Finger, ...] = ("little", "ring", "middle", "index", "thumb")
"""The five fingers in the hand's own order."""

Joints = Dict[Joint, Optional[int]]  # A value of each joint, by its name.


class _Value:
    """A value of `__slots__`, which a frozen dataclass cannot be copied as without this."""

    __slots__ = ()

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), tuple(getattr(self, one.name) for one in fields(cast(Any, self)))


@dataclass(frozen=True)
class Touch(_Value):
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
    __slots__ = tuple(__annotations__)


@dataclass(frozen=True)
class Grip(_Value):
    """What the hand does to an object."""

    state: GripState
    fingers: Mapping[Finger, GripState]
    """The same of each finger."""
    __slots__ = tuple(__annotations__)

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

    end: MoveEnd
    """`reached`; `stopped`: at rest elsewhere, by an object or a force threshold; `late`: it took too long, and was stopped."""
    __slots__ = tuple(__annotations__)

    @classmethod
    def _done(cls, told: Mapping[str, Any]) -> "GripResult":
        grip = Grip._of(told["grip"])
        return cls(grip.state, grip.fingers, told["end"])


@dataclass(frozen=True, repr=False)
class State(_Value):
    """One reading of the hand."""

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
    __slots__ = tuple(__annotations__)

    @property
    def age_s(self) -> float:
        """Seconds since it came."""
        return time.monotonic() - self.received

    def __repr__(self) -> str:
        shown = (f"{one.name}={getattr(self, one.name)!r}" for one in fields(self) if one.name not in ("raw", "received"))
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
            touch={tip["finger"]: Touch(**{one.name: tip[one.name] for one in fields(Touch)}) for tip in told["tactile"]},
            grip=Grip._of(told["grip"]),
            undocumented={(one["field"], one.get("joint") or one["finger"]): one["raw"] for one in told["undocumented"]},
            lost=lost,
            raw=told,
            received=time.monotonic(),
        )


# What commands tell, as `handscope help json` has it.
GripEnd = Literal["held", "reached", "stopped", "not_opened", "late", "person", "taken_over", "fault", "link_lost", "disarmed"]
Light = Literal["fine", "watch", "act", "unknown"]
Whole = Optional[int]
Figure = Optional[float]
Words = Optional[str]
Told = Mapping[str, Any]

TrialJoint = TypedDict("TrialJoint", {
    "joint": Joint, "contact_angle": Figure, "contact_at_start": bool, "clipped": Optional[bool], "peak_force_g": Figure,
    "peak_doubt": Words, "peak_missed_g": Figure, "overshoot_g": Figure, "steady_force_g": Figure, "rest_force_g": float,
    "relaxation_g": Figure, "noise_g": float, "dead_time_s": Figure, "time_to_touch_s": Figure, "time_to_contact_s": Figure,
    "time_to_stop_s": Figure, "settle_time_s": Figure, "slip_count": Whole, "peak_current_ma": float, "rate_hz": float,
    "temperature_rise_c": float, "longest_gap_s": float, "end_status": str,
    "peak_force_n": Figure, "steady_force_n": Figure})  # fmt: skip
Trial = TypedDict("Trial", {
    "number": int, "kind": str, "repeat": Whole, "speed": int, "force_threshold_g": int, "aborted": Words, "stall_s": Figure,
    "samples": Words, "rows": int, "rows_lost": int, "joints": List[TrialJoint]})  # fmt: skip
Tune = TypedDict("Tune", {
    "hand": str, "folder": Words, "limit_g": int, "hold_g": int, "result": Words, "why": Words, "speed": Whole, "closes": Whole,
    "force_threshold_g": Whole, "approach": Optional[Told], "contact_angle": Figure, "close_s": Figure, "peak_bound_g": Figure,
    "peak_bound_n": Figure, "confidence": Figure, "coverage": Figure, "distribution_free": bool, "closes_here": Whole,
    "trials": int, "peaks_g": Optional[List[float]], "joints": Optional[List[Told]], "tried": List[Told], "stop": Optional[Told],
    "compared": Optional[List[Told]], "untold": List[str], "aborted": Words})  # fmt: skip
Checked = TypedDict("Checked", {
    "what": str, "of": str, "measured": Figure, "unit": str, "good": List[Figure], "light": Light, "advice": Words,
    "first": Figure, "last": Figure, "past": List[Told], "drift": Optional[Told], "channels": List[int]})  # fmt: skip
Check = TypedDict("Check", {
    "hand": str, "at": str, "complete": bool, "aborted": Words, "earlier": int, "kept": bool, "remarks": List[str],
    "usage": Optional[Told], "checks": List[Checked]})  # fmt: skip
Gripped = TypedDict("Gripped", {
    "hand": str, "kind": str, "end": GripEnd, "state": GripState, "asked_mm": float, "gap_mm": Figure, "size_mm": Figure,
    "size_by": Words, "size_of": Words, "stop": Optional[Told]})  # fmt: skip

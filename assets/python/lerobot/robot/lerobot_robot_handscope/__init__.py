"""The FTP series tactile hand as a LeRobot robot: `lerobot-record --robot.type=handscope --robot.arm=true`.

Joints are named as unitree_lerobot has them, and are 0 bent to 1 open, as in `handscope export --lerobot`.
"""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass, field
from typing import Any

import handscope
from lerobot.cameras import CameraConfig, make_cameras_from_configs
from lerobot.robots import Robot, RobotConfig

JOINTS = dict(zip(handscope.JOINTS, ("Pinky", "Ring", "Middle", "Index", "ThumbBend", "ThumbRotation")))
FINGERS = dict(zip(handscope.FINGERS, ("Pinky", "Ring", "Middle", "Index", "Thumb")))


@RobotConfig.register_subclass("handscope")
@dataclass(kw_only=True)
class HandscopeConfig(RobotConfig):
    """Which hand, and how it may move."""

    url: str = "sim:"
    """The hand, as `handscope help hands` has it."""
    side: str = "right"
    arm: bool = False
    """Move the hand: nothing is in its way, and the 24 V switch is in reach. Without this, actions are refused."""
    speed: int | None = None
    """Speed of the drives; gentle if none is named."""
    force_g: int | None = None
    """Force threshold of all joints; gentle if none is named."""
    watch: bool = False
    """Another program moves the hand: the window, a gamepad, a stream. Actions are recorded, and not sent."""
    hz: float = 100.0
    """States that are read a second."""
    cameras: dict[str, CameraConfig] = field(default_factory=dict)
    """Cameras of LeRobot, by the names that their pictures have."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.arm and self.watch:
            raise ValueError("a hand that another program moves is not armed here: leave out --robot.arm or --robot.watch")


def open_shared(url: str, **options: Any) -> handscope.Hand:
    """The hand; one that this process has open already, as a teleoperator that leads by its targets has, is shared with it."""
    open_here = [hand.share_url for hand in handscope.hands() if url in (hand.url, hand.asked_url) and not hand.simulated]
    return handscope.open(next(iter(open_here), url), **options)


class Handscope(Robot):
    """One hand. It begins to move with the first action, from where it is, and stops where it is disconnected."""

    config_class = HandscopeConfig
    name = "handscope"

    def __init__(self, config: HandscopeConfig) -> None:
        super().__init__(config)
        self.config = config
        self.cameras: dict[str, Any] = make_cameras_from_configs(config.cameras)
        self._prefix = f"k{config.side.capitalize()}Hand"
        self._hand: handscope.Hand | None = None
        self._armed = contextlib.ExitStack()
        self._is_armed = False

    def _joint(self, name: str) -> str:
        return self._prefix + JOINTS[name]

    @property
    def observation_features(self) -> dict[str, Any]:
        tips = [self._prefix + finger for finger in FINGERS.values()]
        joints = list(self.action_features)
        touch = [tip + what for what in ("Normal", "Tangential") for tip in tips]
        numbers = {name: float for name in [*joints, *(joint + "Force" for joint in joints), *touch]}
        return {**numbers, **{name: (camera.height, camera.width, 3) for name, camera in self.cameras.items()}}

    @property
    def action_features(self) -> dict[str, type]:
        return {self._joint(joint): float for joint in handscope.JOINTS}

    @property
    def is_connected(self) -> bool:
        return self._hand is not None and all(camera.is_connected for camera in self.cameras.values())

    @property
    def is_calibrated(self) -> bool:
        return True

    def connect(self, calibrate: bool = True) -> None:
        if self._hand is not None:
            raise handscope.HandscopeError(f"{self} is connected already")
        with contextlib.ExitStack() as opened:
            hand = opened.enter_context(open_shared(self.config.url, hz=self.config.hz, side=self.config.side))
            with hand.states() as states:
                for state in states:
                    if all(tip.normal_n is not None for tip in state.touch.values()) or state.t_s > 3:
                        break
            for camera in self.cameras.values():
                camera.connect()
                opened.callback(camera.disconnect)
            # All are there: none is closed again.
            opened.pop_all()
        self._hand = hand

    def calibrate(self) -> None:
        """The hand needs none."""

    def configure(self) -> None:
        """The hand keeps its own settings."""

    def _connected(self) -> handscope.Hand:
        if self._hand is None:
            raise handscope.HandscopeError(f"{self} is not connected")
        return self._hand

    def get_observation(self) -> dict[str, Any]:
        """The newest reading, and the newest picture of each camera; what is not known is NaN."""
        state = self._connected().state
        seen: dict[str, Any] = {}
        for joint in handscope.JOINTS:
            angle, force = state.angle[joint], state.force_g[joint]
            seen[self._joint(joint)] = math.nan if angle is None else angle / 1000
            seen[self._joint(joint) + "Force"] = math.nan if force is None else float(force)
        for finger, name in FINGERS.items():
            tip = state.touch[finger]
            seen[f"{self._prefix}{name}Normal"] = math.nan if tip.normal_n is None else tip.normal_n
            seen[f"{self._prefix}{name}Tangential"] = math.nan if tip.tangential_n is None else tip.tangential_n
        for name, camera in self.cameras.items():
            # Older versions of LeRobot have no other way.
            seen[name] = getattr(camera, "read_latest", camera.async_read)()
        return {name: seen[name] for name in self.observation_features}

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Sends targets to be followed; gives them as they were sent, within 0 to 1."""
        hand = self._connected()
        if self.config.watch:
            return action
        if not self.config.arm:
            raise handscope.NotArmed("nothing was moved: when nothing is in the way of the hand, add --robot.arm=true")
        if not self._is_armed:
            self._armed.enter_context(hand.armed(speed=self.config.speed, force_g=self.config.force_g))
            self._is_armed = True
        wanted = {joint: float(action[self._joint(joint)]) for joint in handscope.JOINTS}
        sent = {joint: min(1.0, max(0.0, value)) for joint, value in wanted.items() if math.isfinite(value)}
        hand.follow(**sent)
        return {self._joint(joint): sent.get(joint, wanted[joint]) for joint in handscope.JOINTS}

    def disconnect(self) -> None:
        """Stops the hand, and ends its program and the cameras."""
        hand = self._connected()
        self._hand, self._is_armed = None, False
        with contextlib.ExitStack() as ends:
            for camera in self.cameras.values():
                ends.callback(camera.disconnect)
            ends.callback(hand.close)
            self._armed.close()

"""A hand as a LeRobot teleoperator, which is only read: what its joints do, another robot follows; or what it is told, is the
action of the same hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import handscope
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig

TARGETS_HZ = 30.0
JOINTS = dict(zip(handscope.JOINTS, ("Pinky", "Ring", "Middle", "Index", "ThumbBend", "ThumbRotation")))


@TeleoperatorConfig.register_subclass("handscope")
@dataclass(kw_only=True)
class HandscopeTeleoperatorConfig(TeleoperatorConfig):
    """Which hand leads."""

    url: str = "sim:?scenario=grasp"
    """The hand, as `handscope help hands` has it; the built-in one that grasps by itself, if none is named."""
    targets: bool = False
    """Lead by what the hand is told, in place of where its joints are. One hand is enough then: the window, a gamepad or a stream
    moves it, and the robot has the same URL and `--robot.watch=true`."""
    side: str = "right"
    """Side of the hand that follows, after which its joints are named."""


class HandscopeTeleoperator(Teleoperator):
    """One hand that leads."""

    config_class = HandscopeTeleoperatorConfig
    name = "handscope"

    def __init__(self, config: HandscopeTeleoperatorConfig) -> None:
        super().__init__(config)
        self.config = config
        self._prefix = f"k{config.side.capitalize()}Hand"
        self._hand: handscope.Hand | None = None
        self._led: dict[str, float] = {}

    @property
    def action_features(self) -> dict[str, type]:
        return {self._prefix + name: float for name in JOINTS.values()}

    @property
    def feedback_features(self) -> dict[str, type]:
        return {}

    @property
    def is_connected(self) -> bool:
        return self._hand is not None

    @property
    def is_calibrated(self) -> bool:
        return True

    def connect(self, calibrate: bool = True) -> None:
        if self._hand is not None:
            raise handscope.HandscopeError(f"{self} is connected already")
        url = self.config.url
        open_here = [hand.share_url for hand in handscope.hands() if url in (hand.url, hand.asked_url) and not hand.simulated]
        self._hand = handscope.open(next(iter(open_here), url))
        if self.config.targets:
            self._hand.rate(100, TARGETS_HZ)
        self._led = {}

    def calibrate(self) -> None:
        """The hand needs none."""

    def configure(self) -> None:
        """The hand keeps its own settings."""

    def get_action(self) -> dict[str, Any]:
        """Where the joints of the leading hand are, or what it is told: 0 bent to 1 open. One that reads outside its range leads
        to where it was last, and one that was told nothing to where it is."""
        if self._hand is None:
            raise handscope.HandscopeError(f"{self} is not connected")
        state = self._hand.state
        for joint, angle in state.angle.items():
            if self.config.targets and state.target[joint] is not None:
                angle = state.target[joint]
            if angle is not None:
                self._led[self._prefix + JOINTS[joint]] = angle / 1000
            elif self._prefix + JOINTS[joint] not in self._led:
                raise handscope.HandscopeError(f"the leading hand does not tell where its {joint} is")
        return dict(self._led)

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        """A hand cannot be felt by whoever leads it."""

    def disconnect(self) -> None:
        """Ends its program."""
        if self._hand is None:
            raise handscope.HandscopeError(f"{self} is not connected")
        hand, self._hand = self._hand, None
        hand.close()

"""A second hand as a LeRobot teleoperator: what its joints do, another robot follows. It is only read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import handscope
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig

JOINTS = dict(zip(handscope.JOINTS, ("Pinky", "Ring", "Middle", "Index", "ThumbBend", "ThumbRotation")))


@TeleoperatorConfig.register_subclass("handscope")
@dataclass(kw_only=True)
class HandscopeTeleoperatorConfig(TeleoperatorConfig):
    """Which hand leads."""

    url: str = "sim:?scenario=grasp"
    """The hand, as `handscope help hands` has it; the built-in one that grasps by itself, if none is named."""
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
        self._hand = handscope.open(self.config.url)
        self._led = {}

    def calibrate(self) -> None:
        """The hand needs none."""

    def configure(self) -> None:
        """The hand keeps its own settings."""

    def get_action(self) -> dict[str, Any]:
        """Where the joints of the leading hand are: 0 bent to 1 open. One that reads outside its range leads to where it was last."""
        if self._hand is None:
            raise handscope.HandscopeError(f"{self} is not connected")
        for joint, angle in self._hand.state.angle.items():
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

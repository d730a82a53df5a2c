"""The plug-ins on simulated hands, with LeRobot's own classes replaced by small ones: LeRobot needs three gigabytes.
`lerobot_plugins.py` uses the real ones, where they are installed."""

import contextlib
import dataclasses
import importlib
import pathlib
import sys
import time
import types
import unittest

import handscope
from test_hand import again, until

JOINTS = ["Pinky", "Ring", "Middle", "Index", "ThumbBend", "ThumbRotation"]


@dataclasses.dataclass
class Config:
    id: str = None

    def __post_init__(self):
        for camera in getattr(self, "cameras", {}).values():
            assert camera.width and camera.height and camera.fps, "as LeRobot demands"

    @classmethod
    def register_subclass(cls, name):
        return lambda config: config


class Device:
    def __init__(self, config):
        self.id = config.id


@dataclasses.dataclass
class CameraConfig:
    width: int = 4
    height: int = 3
    fps: int = 30
    fails: bool = False


class Camera:
    def __init__(self, config):
        self.width, self.height, self.fails = config.width, config.height, config.fails
        self.is_connected = False

    def connect(self):
        if self.fails:
            raise ConnectionError("no camera there")
        self.is_connected = True

    def disconnect(self):
        self.is_connected = False

    def async_read(self):
        assert self.is_connected
        return [[[0, 0, 255]] * self.width] * self.height


def plugin(name):
    """A plug-in, in a process that has no LeRobot."""
    cameras = {"CameraConfig": CameraConfig, "make_cameras_from_configs": lambda configs: {k: Camera(c) for k, c in configs.items()}}
    for module, members in {
        "lerobot": {},
        "lerobot.cameras": cameras,
        "lerobot.robots": {"Robot": Device, "RobotConfig": Config},
        "lerobot.teleoperators": {"Teleoperator": Device, "TeleoperatorConfig": Config},
    }.items():
        sys.modules[module] = types.ModuleType(module)
        vars(sys.modules[module]).update(members)
    folder = pathlib.Path(__file__).parent.parent / "lerobot" / name
    sys.path.insert(0, str(folder))
    return importlib.import_module(f"lerobot_{name}_handscope")


@unittest.skipIf(sys.version_info < (3, 10), "LeRobot needs a newer Python")
class Robots(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robots, cls.teleoperators = plugin("robot"), plugin("teleoperator")

    def robot(self, **options):
        return self.robots.Handscope(self.robots.HandscopeConfig(**options))

    def test_a_picture_of_each_camera_is_observed(self):
        robot = self.robot(cameras={"front": CameraConfig(), "wrist": CameraConfig(width=2)})
        self.assertEqual(robot.observation_features["front"], (3, 4, 3))
        self.assertEqual(robot.observation_features["wrist"], (3, 2, 3))
        self.assertFalse(robot.is_connected)
        robot.connect()
        self.assertTrue(robot.is_connected)
        seen = robot.get_observation()
        self.assertEqual(list(seen), list(robot.observation_features))
        self.assertEqual((len(seen["wrist"]), len(seen["wrist"][0])), (3, 2))
        self.assertEqual(seen["kRightHandIndex"], 1.0)
        robot.disconnect()
        self.assertEqual([camera.is_connected for camera in robot.cameras.values()], [False, False])
        self.assertEqual(handscope.hands(), [])

    def test_a_camera_that_is_not_there_leaves_nothing_open(self):
        robot = self.robot(cameras={"front": CameraConfig(), "wrist": CameraConfig(fails=True)})
        with self.assertRaises(ConnectionError):
            robot.connect()
        self.assertFalse(robot.cameras["front"].is_connected)
        self.assertEqual((robot.is_connected, handscope.hands()), (False, []))

    def test_one_hand_that_another_program_moves_leads_and_is_recorded(self):
        again(self.led_by_targets)

    def led_by_targets(self):
        # The other program stands for the window, a gamepad or a stream.
        with handscope.open("sim:?scenario=free") as other, contextlib.ExitStack() as ends:
            shared = other.share_url
            teleop = self.teleoperators.HandscopeTeleoperator(
                self.teleoperators.HandscopeTeleoperatorConfig(url=shared, targets=True)
            )
            robot = self.robot(url=shared, watch=True)
            for device in (teleop, robot):
                device.connect()
                ends.callback(device.disconnect)
            self.assertEqual(robot.action_features, teleop.action_features)
            with other.armed():
                motion = other.move(index=300, speed=100, wait=False)
                begun = time.monotonic()
                until(lambda: teleop.get_action()["kRightHandIndex"] == 0.3 or motion.done)
                # The joint itself is still on its way.
                self.assertGreater(robot.get_observation()["kRightHandIndex"], 0.5)
                print(f"led by a target {(time.monotonic() - begun) * 1000:.0f} ms after it was asked for")
                action = teleop.get_action()
                self.assertEqual(robot.send_action(action), action)
                self.assertEqual(motion.result().end, "reached", "and nothing has taken the hand from the other program")
            ends.close()
            self.assertEqual(handscope.hands(), [other])

    def test_a_hand_is_either_armed_or_watched(self):
        with self.assertRaisesRegex(ValueError, "--robot.watch"):
            self.robot(arm=True, watch=True)


if __name__ == "__main__":
    unittest.main()

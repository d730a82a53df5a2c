"""The plug-ins as the real LeRobot finds and uses them: lerobot_plugins.py FOLDER. Records ten episodes, loads and replays them."""

import os
import pathlib
import subprocess
import sys
import time

import handscope
from handscope import program
from lerobot.datasets import LeRobotDataset
from lerobot.processor import make_default_processors
from lerobot.robots import RobotConfig, make_robot_from_config
from lerobot.scripts.lerobot_record import record_loop
from lerobot.teleoperators import TeleoperatorConfig, make_teleoperator_from_config
from lerobot.utils.constants import ACTION, OBS_STR
from lerobot.utils.feature_utils import combine_feature_dicts, hw_to_dataset_features
from lerobot.utils.import_utils import register_third_party_plugins

EPISODES, SECONDS, FPS = 10, 2, 30
ARRIVES_FRAMES = 20 * FPS

register_third_party_plugins()
folder = pathlib.Path(sys.argv[1])
follower = RobotConfig.get_choice_class("handscope")
leader = TeleoperatorConfig.get_choice_class("handscope")
kept = {"calibration_dir": folder / "calibration"}

# Nothing moves unless that is said.
still = make_robot_from_config(follower(url="sim:", **kept))
still.connect()
try:
    still.send_action({name: 0.0 for name in still.action_features})
    raise SystemExit("it moved without --robot.arm")
except handscope.NotArmed as error:
    print(error)
assert set(still.get_observation()) == set(still.observation_features)
still.disconnect()

# Nothing is between the fingers of the follower, so that it can go wherever the leader is, at whatever moment of its grasp.
robot = make_robot_from_config(follower(url="sim:?scenario=free", arm=True, **kept))
teleop = make_teleoperator_from_config(leader(url="sim:?scenario=grasp", **kept))
assert list(robot.action_features)[0] == "kRightHandPinky", robot.action_features
assert robot.action_features == teleop.action_features
features = combine_feature_dicts(
    hw_to_dataset_features(robot.action_features, ACTION), hw_to_dataset_features(robot.observation_features, OBS_STR)
)
dataset = LeRobotDataset.create("handscope/test", FPS, features, root=folder / "set", robot_type=robot.name, use_videos=False)
robot.connect()
teleop.connect()
to_action, to_robot, to_seen = make_default_processors()
for episode in range(EPISODES):
    record_loop(
        robot=robot,
        events={"exit_early": False, "rerecord_episode": False, "stop_recording": False},
        fps=FPS,
        teleop_action_processor=to_action,
        robot_action_processor=to_robot,
        robot_observation_processor=to_seen,
        dataset=dataset,
        teleop=teleop,
        control_time_s=SECONDS,
        single_task="grasp",
    )
    dataset.save_episode()
    time.sleep(1.5)  # as while a person puts the object back: the hand is held, and followed again
robot.disconnect()
teleop.disconnect()

# A reading that no hand can mean leads nowhere.
wild = make_teleoperator_from_config(leader(url="sim:?scenario=extremes", **kept))
wild.connect()
for _ in range(3 * FPS):
    try:
        assert all(0 <= value <= 1 for value in wild.get_action().values())
    except handscope.HandscopeError as error:
        assert "does not tell where" in str(error), error
    time.sleep(1 / FPS)
wild.disconnect()
dataset.finalize()

loaded = LeRobotDataset("handscope/test", root=folder / "set")
assert loaded.num_episodes == EPISODES and loaded.num_frames > EPISODES * SECONDS * FPS * 0.5, loaded.num_frames
frames = loaded.hf_dataset
names = loaded.features[ACTION]["names"]
actions = [[float(value) for value in frame] for frame in frames[ACTION]]
index = names.index("kRightHandIndex")
assert min(action[index] for action in actions) < 0.8, "the leading hand grasped"
print(loaded.num_episodes, "episodes,", loaded.num_frames, "frames of", names)

# An action may have been anywhere within a grasp; a hand that goes on being asked for it is there in the end.
robot.connect()
recording = robot._hand.record(folder / "session.mcap")
for action in actions[:120]:
    robot.send_action(dict(zip(names, action)))
    time.sleep(1 / FPS)
for _ in range(ARRIVES_FRAMES):
    robot.send_action(dict(zip(names, actions[119])))
    time.sleep(1 / FPS)
    seen = robot.get_observation()
    error = max(abs(seen[name] - value) for name, value in zip(names, actions[119]))
    if error < 0.1:
        break
print(f"replayed, and within {error:.3f} of the last action")
assert error < 0.1, (seen, actions[119])
recording.end()
robot.disconnect()

# What is exported of it passes the checks that others wrote, where they are installed.
home = folder / "home"
exported = ["export", str(folder / "session.mcap"), "--lerobot", "--from", "1", "--out", str(home / "local/replay")]
(home / "local").mkdir(parents=True)
assert program.run(exported).why is None
tools = pathlib.Path(sys.executable).parent
for tool, arguments, words in (
    ("lerobot-doctor", ["check", str(home / "local/replay")], "[PASS] Action Quality"),
    ("lelint", ["check", "local/replay", "--no-video"], "0 errors, 0 warnings"),
):
    if not (tools / tool).exists():
        print(f"skipped: {tool} is not installed")
        continue
    places = {**os.environ, "HF_LEROBOT_HOME": str(home), "HF_HUB_OFFLINE": "1"}
    done = subprocess.run([tools / tool, *arguments], env=places, capture_output=True, text=True)
    # lelint ends with status 1 for remarks such as the number of episodes.
    assert done.returncode < 2 and words in done.stdout, (tool, done.stdout, done.stderr)
    print(tool, "finds nothing wrong")

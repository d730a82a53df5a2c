"""The package with the real program, on simulated hands: python -m unittest discover assets/python/tests

HANDSCOPE_SECONDS is how long 500 states a second are read (5).
"""

import contextlib
import copy
import ctypes
import gc
import importlib.util
import os
import pathlib
import pickle
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

import handscope
from handscope import program

STOPS_WITHIN_S = 0.3
INDEX_SET, INDEX_ACT = 1492, 1552


@contextlib.contextmanager
def simulated():
    """A hand served by another process, and a client of its registers, which knows nothing of Handscope."""
    command = [program.find(), "sim", "--tcp", "127.0.0.1:0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as sim:
        try:
            address = sim.stdout.readline().split()[2]
            host, port = address.rsplit(":", 1)
            with socket.create_connection((host, int(port))) as client:
                client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

                def read(register):
                    client.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, 3, register, 1))
                    return struct.unpack(">HHHBBBH", client.recv(64))[6]

                yield f"tcp:{address}", read
        finally:
            sim.terminate()


@contextlib.contextmanager
def script(hand, text):
    """A script that moves the index finger slowly, once it says so."""
    head = f"import handscope, time, sys, os, signal\nhand = handscope.open({hand!r})\n"
    # Whoever runs these tests in the background may have Ctrl-C ignored.
    with subprocess.Popen(
        [sys.executable, "-c", head + textwrap.dedent(text)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as running:
        try:
            yield running
        finally:
            running.kill()


MOVES = """
import threading
with hand.armed():
    threading.Timer(0.4, lambda: print("moves", flush=True)).start()
    hand.move(index=0, speed=50)
"""


class Stops(unittest.TestCase):
    def held_within(self, read, since):
        while read(INDEX_SET) == 0:
            self.assertLess(time.monotonic() - since, 20, "it goes on")
        took = time.monotonic() - since
        self.assertLess(took, STOPS_WITHIN_S)
        self.assertGreater(read(INDEX_SET), 300)
        return took

    def ended_by(self, number, text=MOVES):
        with simulated() as (hand, read), script(hand, text) as running:
            self.assertEqual(running.stdout.readline(), "moves\n", running.stderr.read if running.poll() else "")
            self.assertEqual(read(INDEX_SET), 0)
            since = time.monotonic()
            running.send_signal(number)
            took = self.held_within(read, since)
            running.wait(20)
            return took, running.stderr.read()

    def test_kill_9_stops_the_hand(self):
        took, _ = self.ended_by(signal.SIGKILL)
        print(f"held {took * 1000:.0f} ms after kill -9")

    def test_ctrl_c_stops_the_hand(self):
        _, said = self.ended_by(signal.SIGINT)
        self.assertIn("KeyboardInterrupt", said)

    def test_a_forked_worker_does_not_keep_the_hand_moving(self):
        worker = "\nif os.fork() == 0:\n    [os.close(n) for n in (1, 2)]\n    time.sleep(5)\n    os._exit(0)\n"
        self.ended_by(signal.SIGKILL, worker + MOVES)

    def test_an_exception_in_the_block_stops_the_hand_and_passes(self):
        with simulated() as (url, read), handscope.open(url) as hand:
            with self.assertRaises(ZeroDivisionError), hand.armed():
                threading.Thread(target=lambda: self.assertRaises(handscope.HandscopeError, hand.move, index=0, speed=50)).start()
                while read(INDEX_SET) != 0:
                    time.sleep(0.01)
                time.sleep(0.3)
                1 / 0
            self.assertGreater(read(INDEX_SET), 500)


    def test_what_a_forked_worker_knows_of_the_hand_is_refused_there(self):
        with simulated() as (url, _), handscope.open(url) as hand:
            self.assertIsNotNone(hand.state.t_s)
            heard, told = os.pipe()
            worker = os.fork()
            if worker == 0:
                acts = [lambda: hand.state, hand.stop, lambda: next(hand.states()), lambda: hand.follow(index=0.5)]
                errors = [error_of(act) for act in acts]
                os.write(told, "\n".join(f"{getattr(error, 'kind', None)} {error}" for error in errors).encode())
                hand.close()
                os._exit(0)
            os.waitpid(worker, 0)
            errors = os.read(heard, 65536).decode().splitlines()
            self.assertEqual(len(errors), 4, errors)
            for error in errors:
                self.assertRegex(error, f"^other_process this hand belongs to process {os.getpid()}")
            self.assertLess(hand.state.age_s, 5, "and goes on here")

    def ended_well(self, text):
        with simulated() as (url, read), script(url, text) as running:
            said = running.communicate(timeout=60)
            self.assertEqual((running.returncode, said[1]), (0, ""), said)
            self.assertEqual(read(INDEX_SET), 1000)

    def test_a_hand_that_is_closed_while_python_ends_ends_well(self):
        for _ in range(3):
            self.ended_well("""
                class Robot:
                    def __init__(self, hand):
                        self.hand, self.itself = hand, self
                    def __del__(self):
                        self.hand.close()
                robot = Robot(hand)
                print(hand.state.t_s)
            """)

    def test_a_hand_that_is_still_armed_while_python_ends_ends_well(self):
        self.ended_well("import contextlib\nstack = contextlib.ExitStack()\nstack.enter_context(hand.armed())\n")


def children():
    """The programs of this script that run."""
    return [hand._program.pid for hand in handscope.hands()]


def is_running(pid):
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


class Opens(unittest.TestCase):
    def test_one_that_fails_leaves_nothing_running(self):
        started = []
        begin = program.Program.__init__

        def noted(self, *arguments):
            begin(self, *arguments)
            started.append(self.pid)

        program.Program.__init__ = noted
        try:
            for hz in (2000, 0, float("nan"), "fast"):
                with self.assertRaises((handscope.Refused, ValueError)):
                    handscope.open("sim:", hz=hz)
        finally:
            program.Program.__init__ = begin
        self.assertEqual(len(started), 4)
        self.assertFalse([pid for pid in started if is_running(pid)])

    def test_one_that_is_forgotten_is_closed(self):
        hand = handscope.open("sim:")
        pid = hand._program.pid
        with hand.states() as states:
            next(states)
        self.assertIn(hand, handscope.hands())
        del hand, states
        gc.collect()
        until(lambda: not is_running(pid))
        self.assertNotIn(pid, children())

    def test_the_same_hand_again_names_the_first(self):
        with simulated() as (url, _), handscope.open(url) as hand:
            for again in (url, hand.url):
                with self.assertRaisesRegex(handscope.Refused, "open in this script already.*close") as error:
                    handscope.open(again)
                self.assertEqual(error.exception.kind, "open_already")
            with handscope.open(hand.share_url) as one, handscope.open(hand.share_url) as two:
                self.assertEqual(handscope.hands().count(one) + handscope.hands().count(two), 2, "that is what it is for")
            hand.close()
            with handscope.open(url) as later:
                self.assertTrue(later.state.angle)
        with handscope.open("sim:") as one, handscope.open("sim:") as other:
            self.assertNotEqual(one.share_url, other.share_url, "a simulated hand is another one each time")

    def test_without_writers_no_other_program_moves_it(self):
        with handscope.open("sim:", writers=False) as hand, handscope.open(hand.share_url) as other:
            with self.assertRaises(handscope.Taken), other.armed():
                self.fail("nobody may")


class Moves(unittest.TestCase):
    def test_nothing_moves_outside_armed(self):
        with handscope.open("sim:") as hand:
            for act in (
                lambda: hand.move(index=0),
                lambda: hand.close_until(300),
                lambda: hand.follow(index=0.0),
                lambda: hand.trial("index"),
            ):
                with self.assertRaisesRegex(handscope.NotArmed, "only inside 'with hand.armed"):
                    act()
            with hand.armed():
                pass
            with self.assertRaises(handscope.NotArmed):
                hand.move(index=0)
            self.assertEqual(hand.state.angle["index"], 1000)

    def test_a_grasp_tells_what_it_holds(self):
        with handscope.open("sim:") as hand, hand.armed():
            self.assertEqual(hand.move(index=800, speed=500).end, "reached")
            grip = hand.close_until(force_g=300, joints=("index", "thumb_bend"), speed=300)
            self.assertTrue(grip.holding and not grip.empty, grip)
            self.assertEqual((grip.end, grip.fingers["index"]), ("stopped", "holding"))
            self.assertGreater(hand.state.force_g["index"], 100)
            self.assertIsNone(hand.state.force_n["index"], "it was measured on no scale")
            self.assertGreater(hand.touch["index"].normal_n, 0.5)

    def test_what_is_wrong_is_told_in_the_programs_words_and_moves_nothing(self):
        with handscope.open("sim:") as hand, hand.armed():
            for error, words, act in (
                (handscope.Refused, "0 to 1000", lambda: hand.move(index=1400)),
                (handscope.Refused, "rated for 2000 g", lambda: hand.close_until(2500)),
                (ValueError, "thumb_bend", lambda: hand.move(thumb=3)),
                (handscope.HandscopeError, "3 to 120", lambda: hand.grip_to(1)),
                (handscope.HandscopeError, "no room for a hold", lambda: hand.hold(5, at_least=200, at_most=210)),
                (handscope.HandscopeError, "no pose 'Cube'", lambda: hand.hold(5, pose="Cube")),
            ):
                with self.assertRaisesRegex(error, words):
                    act()
            self.assertEqual(hand.state.angle["index"], 1000)
            self.assertEqual(hand.move(index=900, speed=500).end, "reached", "it goes on after that")

    def test_figures_of_armed_are_those_of_move_and_close_until(self):
        speed_set, force_set = 1528, 1504
        with simulated() as (url, read), handscope.open(url) as hand:
            with hand.armed(speed=700, force_g=900):
                for act, wanted in (
                    (lambda: hand.move(index=900), (700, 900)),
                    (lambda: hand.move(index=800, speed=300), (300, 900)),
                    (lambda: hand.close_until(400, "index", to=700), (700, 400)),
                    (lambda: hand.move(index=900), (700, 900)),
                ):
                    act()
                    self.assertEqual((read(speed_set), read(force_set)), wanted)
                # What was told is read back about twice a second.
                told = lambda state: (state.target["index"], state.speed["index"], state.threshold_g["index"])
                until(lambda: told(hand.state) == (900, 700, 900))

    def test_a_pose_of_the_library_is_moved_to_as_its_angles_are(self):
        with handscope.open("sim:") as hand:
            with self.assertRaises(handscope.NotArmed):
                hand.pose("Open")
            with hand.armed():
                self.assertEqual(hand.pose("relaxed", speed=1000).end, "reached")
                wanted = {"little": 700, "ring": 720, "middle": 740, "index": 760, "thumb_bend": 850, "thumb_rotate": 800}
                for joint, angle in wanted.items():
                    self.assertAlmostEqual(hand.state.angle[joint], angle, delta=10)
                with self.assertRaisesRegex(handscope.Refused, "no pose 'Cube'"):
                    hand.pose("Cube")

    def test_a_gesture_of_the_hand_is_started_and_its_end_awaited(self):
        with handscope.open("sim:") as hand:
            self.assertEqual(error_of(lambda: hand.gesture(3)).kind, "not_armed")
            self.assertEqual(hand.state.angle["index"], 1000)
            with hand.armed(speed=900):
                result = hand.gesture(3)
                self.assertEqual((result.end, hand.state.angle["little"]), ("reached", 1000))
                self.assertAlmostEqual(hand.state.angle["index"], 420, delta=20)
                self.assertEqual(error_of(lambda: hand.gesture(41)).kind, "wrong")
                self.assertEqual(error_of(lambda: hand.gesture(2.5)).kind, "wrong")
                self.assertAlmostEqual(hand.state.angle["index"], 420, delta=20)

    def test_settings_that_are_not_whole_are_refused_in_a_sentence(self):
        with handscope.open("sim:") as hand, hand.armed():
            for act in (
                lambda: hand.move(index=900, force_g=300.5),
                lambda: hand.move(index=900, speed=True),
                lambda: hand.close_until(300.5),
            ):
                with self.assertRaisesRegex(handscope.Refused, "nothing was moved: .* is not a whole number") as error:
                    act()
                self.assertEqual(error.exception.kind, "wrong")
            self.assertEqual(hand.move(index=900.0, speed=500.0).end, "reached")

    def test_errors_have_a_kind(self):
        with handscope.open("sim:") as hand:
            for kind, act in (
                ("not_armed", lambda: hand.move(index=3)),
                ("wrong", lambda: hand.rate(0)),
                ("refused", lambda: hand._program.ask("record", path=None)),
                ("failed", lambda: handscope.open("hand")),
            ):
                error = error_of(act)
                self.assertEqual((error.kind, str(error)[:1].isalpha()), (kind, True))
                again = pickle.loads(pickle.dumps(error))
                self.assertEqual((type(again), again.kind, str(again)), (type(error), kind, str(error)))

    def test_a_target_of_follow_that_was_refused_is_told_at_the_latest_where_the_block_ends(self):
        with handscope.open("sim:") as hand:
            with self.assertRaisesRegex(handscope.Refused, "0 \\(bent\\) to 1 \\(open\\)"), hand.armed():
                hand.follow(index=400)
            self.assertEqual(hand.state.angle["index"], 1000)

    def test_a_call_that_lets_nothing_else_run_is_named_as_what_disarmed_the_hand(self):
        with handscope.open("sim:", hz=500) as hand:
            with self.assertRaisesRegex(handscope.Disarmed, "did not read its states for a second") as error, hand.armed():
                ctypes.PyDLL(None).sleep(4)  # keeps the lock of the interpreter
                hand.move(index=900)
            self.assertEqual((error.exception.kind, hand.state.angle["index"]), ("silent", 1000))

    def test_a_motion_is_not_waited_for(self):
        with handscope.open("sim:") as hand, hand.armed(speed=200):
            motion = hand.move(index=600, wait=False)
            self.assertFalse(motion.done)
            until(lambda: hand.state.angle["index"] < 900)
            result = motion.result()
            self.assertEqual((result.end, motion.done), ("reached", True))
            self.assertIs(motion.result().end, result.end)
            replaced = hand.move(index=200, wait=False)
            self.assertEqual(hand.move(index=900).end, "reached")
            with self.assertRaises(handscope.Refused) as error:
                replaced.result()
            self.assertEqual(error.exception.kind, "replaced")

    def test_after_a_motion_the_hand_does_not_move(self):
        with handscope.open("sim:?scenario=free") as hand, hand.armed(speed=500):
            for angle, wanted in ((600, "empty"), (1000, "open")):
                result = hand.move(index=angle)
                self.assertEqual((result.end, result.state, result.fingers["index"]), ("reached", wanted, wanted))

    def test_a_share_of_follow_is_no_angle_of_move(self):
        with handscope.open("sim:") as hand, hand.armed():
            for wrong in (0.5, True, float("nan"), float("inf"), "400"):
                with self.assertRaisesRegex(handscope.HandscopeError, "nothing was moved"):
                    hand.move(index=wrong)
            self.assertEqual(hand.state.angle["index"], 1000)

    def test_a_callback_of_states_may_stop_the_hand_and_asks_for_nothing_else(self):
        with handscope.open("sim:") as hand:
            refused = []

            def watch(state):
                if state.angle["index"] < 800:
                    hand.stop()
                    try:
                        hand.clear_faults()
                    except handscope.HandscopeError as error:
                        refused.append(error)

            hand.on_state(watch)
            with self.assertRaises(handscope.HandscopeError), hand.armed():
                hand.move(index=0, speed=100)
            self.assertGreater(hand.state.angle["index"], 500)
            self.assertIn("wait for itself", str(refused[0]))

    def test_a_loop_is_followed(self):
        with handscope.open("sim:") as hand, hand.armed():
            until = time.monotonic() + 20
            while hand.state.angle["index"] > 520:
                hand.follow(index=0.5)
                time.sleep(0.02)
                self.assertLess(time.monotonic(), until)
            self.assertEqual(hand.state.angle["middle"], 1000)

    def test_commands_run_in_the_scripts_place(self):
        options = {"start": 600, "close": 300, "speed": [250], "force": 250, "dwell": 0.3, "rest": 0.1}
        with handscope.open("sim:?scenario=rigid") as hand:

            def trials():
                with hand.armed():
                    done = hand.trial("index", ceiling=4000, **options)
                    self.assertEqual(hand.move(index=900, speed=500).end, "reached")
                    return done

            done = again(trials)
            self.assertEqual(len(done), 1)
            self.assertGreater(done[0]["joints"][0]["peak_force_g"], 200)
            self.assertIsNone(done[0]["joints"][0]["peak_force_n"], "it was measured on no scale")

    def test_after_a_command_that_ended_early_the_hand_is_not_armed(self):
        with handscope.open("sim:") as hand, hand.armed():
            other = threading.Timer(3, hand.stop)
            other.start()
            with self.assertRaisesRegex(handscope.HandscopeError, "ended early"):
                hand.trial("index", speed=25)
            other.join()
            with self.assertRaises(handscope.Disarmed):
                hand.move(index=1000)

    def test_two_scripts_at_one_hand(self):
        with simulated() as (url, _), handscope.open(url) as first, handscope.open(first.share_url) as second:
            moved = []
            with first.armed():
                with self.assertRaisesRegex(handscope.Taken, "armed"), second.armed():
                    self.fail("one at a time")
                mover = threading.Thread(target=lambda: moved.append(error_of(lambda: first.move(index=0, speed=50))))
                mover.start()
                until(lambda: second.state.angle["index"] < 950)
                second.stop()
                mover.join()
                self.assertIsInstance(moved[0], handscope.Disarmed)
                self.assertRegex(str(moved[0]), "a stop was requested")
                with self.assertRaises(handscope.Disarmed):
                    first.move(index=0)

            def moves():
                with second.armed():
                    return second.move(index=900, speed=500)

            self.assertEqual(again(moves).end, "reached")
            self.assertEqual(second.state.angle["index"] // 10, first.state.angle["index"] // 10)


def until(there):
    """Waits. A link through a program that gets no time on a busy machine may be lost for a moment."""
    over = time.monotonic() + 20
    while time.monotonic() < over:
        with contextlib.suppress(handscope.LinkLost):
            if there():
                return
        time.sleep(0.01)
    raise AssertionError("not within 20 s")


def again(act):
    """The same for what ends with such a link."""
    for _ in range(10):
        try:
            return act()
        except handscope.HandscopeError as error:
            if not any(words in str(error) for words in ("the link was lost", "the link is lost", "cannot be armed")):
                raise
        time.sleep(1)
    raise AssertionError("the link was lost each time")


def error_of(act):
    try:
        act()
    except handscope.HandscopeError as error:
        return error


class Hears(unittest.TestCase):
    def test_500_states_a_second_and_none_lost(self):
        seconds = float(os.environ.get("HANDSCOPE_SECONDS", "5"))
        called = []
        with handscope.open("sim:", hz=500) as hand:
            hand.on_state(called.append)
            states, lost, first = 0, 0, None
            for state in hand.states():
                states, lost, first = states + 1, lost + state.lost, first or state
                if state.t_s - first.t_s >= seconds:
                    break
            hz = states / (state.t_s - first.t_s)
        print(f"{states} states, {hz:.0f} a second, {lost} lost")
        self.assertEqual((lost, sum(state.lost for state in called)), (0, 0))
        self.assertGreater(hz, 250, "also on a machine that does other work")

    def test_what_is_not_taken_in_time_is_told_as_lost(self):
        with handscope.open("sim:", hz=500) as hand:
            slow = threading.Event()
            hand.on_state(lambda state: slow.wait(60))
            time.sleep(6)  # the reader is held up by its callback
            seen = hand.states()
            threading.Timer(0.1, slow.set).start()
            lost = 0
            for state in seen:
                lost += state.lost
                if lost:
                    break
            self.assertGreater(lost, 0)

    def test_what_is_outside_the_manual_is_no_value(self):
        with handscope.open("sim:?scenario=extremes") as hand:
            seen = set()
            for state in hand.states():
                for joint, angle in state.angle.items():
                    self.assertTrue(angle is None or 0 <= angle <= 1000, angle)
                    self.assertEqual(angle is None, state.angle_rad[joint] is None)
                    if angle is None:
                        seen.add(state.undocumented["angle", joint])
                known = [temp for temp in state.temp_c.values() if temp is not None]
                self.assertTrue(all(0 <= temp <= 100 for temp in known), known)
                for finger, touch in state.touch.items():
                    if touch.raw:
                        self.assertTrue(touch.tangential_n is None or abs(touch.tangential_n) <= 100, touch)
                        self.assertEqual(touch.normal_n is None, ("normal_n", finger) in state.undocumented)
                if {32767, -7, 1013} <= seen and state.touch["thumb"].raw:
                    break
            self.assertEqual(state.touch["thumb"].normal_n, 20.0)

    def test_a_state_is_a_value(self):
        with handscope.open("sim:") as hand:
            state = hand.state
            self.assertLess(abs(state.time - time.time()), 10)
            self.assertEqual(pickle.loads(pickle.dumps(state)), state)
            self.assertEqual(copy.deepcopy(state.grip), state.grip)
            self.assertIn("angle=", repr(state))
            self.assertLessEqual({"angle", "force_g", "touch", "grip"}, set(dir(state)))
            self.assertFalse(hasattr(state, "__dict__"))
            with self.assertRaises(AttributeError):
                state.angle = {}

    def test_several_hands(self):
        with handscope.open("sim:?seed=1") as one, handscope.open("sim:?seed=2") as other:
            with one.armed(), other.armed():
                one.move(index=800, speed=500)
                self.assertEqual(other.state.angle["index"], 1000)

    def test_a_recording_becomes_a_table(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "grasp.mcap")
            with handscope.open("sim:") as hand:
                with hand.record(path), hand.armed():
                    hand.move(index=700, speed=500)
                with self.assertRaisesRegex(handscope.Refused, "already exists"):
                    hand.record(path)
            frame = handscope.read(path)
            self.assertLessEqual({"time_s", "angle_index", "force_index_g", "normal_thumb_N"}, set(frame.columns))
            self.assertLess(frame["angle_index"].min(), 730)
            self.assertLessEqual({"position_index", "force_threshold_index_g", "status_index"}, set(frame.columns))
            self.assertEqual((str(frame.index.tz), frame.index.is_monotonic_increasing), ("UTC", True))
            self.assertEqual((frame.attrs["hand"], frame.attrs["simulated"]), (hand.url, True))
            self.assertEqual(frame.attrs["units"]["force_index_g"], "g")
            self.assertLess(abs(frame.attrs["start"] - time.time()), 60)
            self.assertIn("armed", [event["kind"] for event in handscope.events(path)])
            self.assertLess(len(handscope.read(path, end_s=0.2)), len(frame))
            with self.assertRaisesRegex(handscope.HandscopeError, "nowhere"):
                handscope.read("nowhere.mcap")

    def test_a_hand_that_is_lost_is_an_exception_and_no_old_value(self):
        with simulated() as (url, _read):
            hand = handscope.open(url)
            self.assertEqual(hand.state.angle["index"], 1000)
        until = time.monotonic() + 20
        with self.assertRaises(handscope.LinkLost), hand:
            while time.monotonic() < until:
                time.sleep(0.01)
                self.assertLess(hand.state.age_s, 5)


class Begins(unittest.TestCase):
    def test_no_hand_is_told_in_one_sentence(self):
        with self.assertRaisesRegex(handscope.HandscopeError, "^no hand at tcp:127.0.0.1:1.*refused the connection"):
            handscope.open("tcp:127.0.0.1:1")
        with self.assertRaisesRegex(handscope.HandscopeError, "does not name a kind of link"):
            handscope.open("hand")

    def in_place_of_the_program(self, text):
        with tempfile.TemporaryDirectory() as folder:
            other = pathlib.Path(folder, "handscope")
            if text:
                other.write_text(f"#!{sys.executable}\n{textwrap.dedent(text)}")
                other.chmod(0o755)
            code = "import handscope\ntry: handscope.open('sim:')\nexcept handscope.ProgramNotFound as error: print(error)"
            places = {**os.environ, "HANDSCOPE": str(other) if text else "", "PATH": folder, "HOME": folder}
            # Not the one beside this package.
            patch = "import sysconfig; sysconfig.get_path = lambda *_: '/nowhere'\n"
            done = subprocess.run([sys.executable, "-c", patch + code], env=places, capture_output=True, text=True)
            return done.stdout + done.stderr

    def test_a_missing_program_is_told_in_one_sentence(self):
        self.assertRegex(self.in_place_of_the_program(None), "^the program 'handscope' is not installed: .*\n$")

    def test_another_version_is_told_in_one_sentence(self):
        older = """
        import sys
        if "--version" in sys.argv: print("handscope 0.0.9")
        else: sys.exit(print("error: unexpected argument '--stdio' found", file=sys.stderr) or 2)
        """
        self.assertRegex(self.in_place_of_the_program(older), "^the program at .* is version 0.0.9, which .*\n$")
        newer = """
        import sys
        print('{"ready": {"v": 2, "program": "9.0.0", "hand": "sim:", "simulated": true, "tcp": null}}', flush=True)
        sys.stdin.read()
        """
        self.assertRegex(self.in_place_of_the_program(newer), "^the program at .* is version 9.0.0, which .*\n$")

    def test_a_line_that_the_end_of_the_program_cut_short_is_its_end(self):
        cut = """
        import sys
        print('{"state": {"angle"', end="", flush=True)
        sys.exit(print("error: killed", file=sys.stderr))
        """
        told = self.in_place_of_the_program(cut)
        self.assertTrue(told.endswith("HandscopeError: killed\n") and "thread" not in told, told)


TYPED = """
import handscope
with handscope.open("sim:") as hand, hand.armed():
    motion: handscope.Motion = hand.move(index=3, wait=False)
    result: handscope.GripResult = hand.move(index=3, thumb_bend=None, speed=20)
    hand.close_until(300, joints="index")
    hand.follow(index=0.3)
    print(hand.touch["thumb"].normal_n, hand.state.angle["index"], hand.grip.state == "holding")
    print(hand.gesture(3).end == "reached", hand.trial("index")[0]["joints"][0]["peak_force_g"])
    print(hand.tune("index", 300)["speed"], hand.check()["checks"][0]["light"] == "act", hand.grip_to(30)["end"] == "held")
    hand.move(idnex=3)  # wrong
    hand.follow(idnex=0.3)  # wrong
    hand.close_until(300, joints=("index", "thumb"))  # wrong
    print(hand.state.force_g["indx"])  # wrong
    print(hand.grip.state == "holdng")  # wrong
    print(result.end == "there")  # wrong
    print(hand.state.angles)  # wrong
    hand.gesture("fist")  # wrong
    print(hand.trial("index")[0]["joint"])  # wrong
    print(hand.trial("index")[0]["joints"][0]["peak"])  # wrong
    print(hand.tune("index", 300)["sped"])  # wrong
    print(hand.check()["checks"][0]["light"] == "red")  # wrong
    print(hand.grip_to(30)["end"] == "hold")  # wrong
"""


class Typed(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_a_name_that_does_not_exist_is_found_before_the_script_runs(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "typed.py")
            path.write_text(TYPED)
            command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--hide-error-context", str(path)]
            package = str(pathlib.Path(handscope.__file__).parent.parent)
            places = {**os.environ, "MYPYPATH": package}
            done = subprocess.run(command, env=places, cwd=folder, capture_output=True, text=True)
        wrong = {number for number, line in enumerate(TYPED.splitlines(), 1) if line.endswith("# wrong")}
        found = {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line}
        self.assertEqual(found, wrong, done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()

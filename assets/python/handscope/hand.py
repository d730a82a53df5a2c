"""One hand: its states, and what moves it."""

from __future__ import annotations

import json
import logging
import numbers
import os
import subprocess
import tempfile
import threading
import time
import weakref
from collections import deque
from contextlib import contextmanager
from typing import Any, Callable, Iterable, Iterator, Literal, Mapping, NoReturn, Optional, Sequence, TypeVar, Union, cast, overload

from . import program
from .errors import Disarmed, HandscopeError, LinkLost, NotArmed, Refused, Taken, of
from .state import JOINTS, Check, Finger, Grip, Gripped, GripResult, Joint, State, Touch, Trial, Tune

# The joints that `close_until` closes, unless others are named.
CLOSING: tuple[Joint, ...] = ("little", "ring", "middle", "index", "thumb_bend")
_WAITING_MAX = 4096
_FIRST_STATE_S = 5.0
_WINDOW_OPENS_S = 2.0
_COMMAND_GONE_S = 1.0

_log = logging.getLogger("handscope")
_hands: "weakref.WeakSet[Hand]" = weakref.WeakSet()

Callback = Callable[[State], None]
Count = Optional[int]
Share = Optional[float]
Told = TypeVar("Told")


def hands() -> list["Hand"]:
    """The hands that this script has open, also those that no name of it is left of."""
    return [hand for hand in list(_hands) if not hand._ended and hand._program.is_own]


class States:
    """States one after the other. One that is not taken in time makes room, and the next says so in `lost`."""

    def __init__(self, hand: "Hand") -> None:
        self._hand = hand
        self._waiting: deque[State] = deque()
        self._lost = 0
        self._news = threading.Condition()

    def _take(self, state: Optional[State]) -> None:
        with self._news:
            if state:
                self._waiting.append(state)
                if len(self._waiting) > _WAITING_MAX:
                    self._lost += 1 + self._waiting.popleft().lost
            self._news.notify_all()

    def __iter__(self) -> "States":
        return self

    def __next__(self) -> State:
        self._hand._program.check()
        with self._news:
            self._news.wait_for(lambda: self._waiting or self._hand._ended or self._hand._link_lost)
            if not self._waiting:
                if self._hand._link_lost and not self._hand._ended:
                    raise LinkLost(self._hand._link_lost, "link_lost")
                raise StopIteration
            state = self._waiting.popleft()
            if self._lost:
                object.__setattr__(state, "lost", state.lost + self._lost)
                self._lost = 0
            return state

    def close(self) -> None:
        """Takes no more."""
        self._hand._readers.discard(self)

    def __enter__(self) -> "States":
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


class Recording:
    """A recording that goes on, until `end()` or the end of its `with` block."""

    def __init__(self, hand: "Hand", path: str) -> None:
        self._hand = hand
        self.path = path
        self._goes_on = True

    def end(self) -> None:
        """Ends the file; it is whole then."""
        if self._goes_on:
            self._goes_on = False
            self._hand._program.ask("record", path=None)

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *_error: object) -> None:
        if not self._hand._ended:
            self.end()


class Motion:
    """A motion that goes on while the script does: `hand.move(index=400, wait=False)`."""

    def __init__(self, hand: "Hand", asked: program.Asked) -> None:
        self._hand = hand
        self._asked = asked

    @property
    def done(self) -> bool:
        """True once it has ended, however it did."""
        return bool(self._asked.reply or self._hand._ended)

    def result(self, timeout_s: Optional[float] = None) -> GripResult:
        """Waits until it has ended; raises what ended it early. The hand goes on if it does not end in time."""
        try:
            return GripResult._done(self._asked.wait(timeout_s))
        except (Disarmed, NotArmed) as why:
            # Why it ended may have been told already, before this was asked.
            self._hand._disarmed = self._hand._disarmed or why
            raise self._hand._disarmed from None


class Hand:
    """A hand that this script shares. `handscope.open` gives one; `close()`, the end of its `with` block, of the script, or of
    the last name that it has there stops what moves."""

    def __init__(self, url: str, hz: float, side: str, port: int, writers: bool) -> None:
        self._news = threading.Condition()
        self._newest: Optional[State] = None
        self._lost = 0
        self._ended: Optional[str] = None
        self._link_lost: Optional[str] = None
        self._disarmed: Optional[HandscopeError] = None
        self._refused: Optional[HandscopeError] = None
        self._armed: Optional[dict[str, Count]] = None
        self._callbacks: list[Callback] = []
        self._readers: "weakref.WeakSet[States]" = weakref.WeakSet()
        self._windows: list["subprocess.Popen[str]"] = []
        options = ["--hand", url, "--side", side, "--tcp", f"127.0.0.1:{port}"]
        self._side = side
        self._began = 0.0
        self._program = _started(url, options + ["--writers"] * writers, weakref.WeakMethod(self._told))
        self._close = weakref.finalize(self, _end, self._program, self._windows)
        ready = self._program.ready or {}
        self.url: str = ready["hand"]  # As the program spells it.
        self.simulated: bool = ready["simulated"]  # True for the built-in hand.
        self.share_url: str = f"tcp:{ready['tcp']}"  # Where other programs of this computer find the same hand.
        self.asked_url = url  # As `open` was given it.
        try:
            self.rate(hz)
        except BaseException:
            self.close()
            raise
        _hands.add(self)

    def _told(self, told: Mapping[str, Any]) -> None:
        # On the thread that reads what the program says.
        if "state" in told:
            state = State._of(told["state"], self._lost, self._began)
            self._lost = 0
            with self._news:
                self._newest = state
                self._link_lost = None
                self._news.notify_all()
            self._pass(state)
            for callback in list(self._callbacks):
                try:
                    callback(state)
                except Exception:
                    _log.exception("a callback of states failed, and is called no more")
                    self._forget(callback)
        elif "lost" in told:
            self._lost += told["lost"]
        elif "disarmed" in told:
            self._disarmed = of(told["disarmed"]["kind"], told["disarmed"]["why"])
        elif "refused" in told:
            self._refused = of(told["refused"]["kind"], told["refused"]["why"])
        elif "ready" in told:
            self._began = told["ready"].get("since_1970_s", 0.0)
        elif "link" in told or "ended" in told:
            with self._news:
                link = told.get("link", {})
                lost = link.get("state") == "lost"
                self._link_lost = (link["why"] or "the link to the hand is lost") if lost else None
                self._ended = told.get("ended")
                self._news.notify_all()
            self._pass(None)

    def _pass(self, state: Optional[State]) -> None:
        for reader in list(self._readers):
            reader._take(state)

    @property
    def state(self) -> State:
        """The newest state. Waits for the first; raises if the hand does not answer any more."""
        self._program.check()
        with self._news:
            self._news.wait_for(lambda: self._newest or self._ended or self._link_lost, _FIRST_STATE_S)
            if self._ended:
                raise HandscopeError(self._ended)
            if self._link_lost:
                raise LinkLost(self._link_lost, "link_lost")
            if not self._newest:
                raise HandscopeError("the hand reports no state")
            return self._newest

    @property
    def touch(self) -> dict[Finger, Touch]:
        """The fingertips of the newest state."""
        return self.state.touch

    @property
    def grip(self) -> Grip:
        """What the hand does to an object, in the newest state."""
        return self.state.grip

    def states(self) -> States:
        """The states from now on, each one: `for state in hand.states():`."""
        self._program.check()
        states = States(self)
        self._readers.add(states)
        return states

    def on_state(self, callback: Callback) -> Callable[[], None]:
        """Calls back with each state from now on, on a thread of its own; gives what ends that. Be quick: what is not read in
        time is lost, and told as lost."""
        self._program.check()
        self._callbacks.append(callback)
        return lambda: self._forget(callback)

    def _forget(self, callback: Callback) -> None:
        if callback in self._callbacks:
            self._callbacks.remove(callback)

    def rate(self, hz: float, target_hz: float = 2.0) -> None:
        """Reads so many states a second, up to 500, or as many as the wire carries, and so often what the hand is told."""
        self._program.ask("rate", state_hz=float(hz), target_hz=float(target_hz))

    @contextmanager
    def armed(self, speed: Count = None, force_g: Count = None) -> Iterator["Hand"]:
        """Lets this script move the hand, with this speed and force threshold where none are named later (gentle ones, if none
        are named here). The hand stops where the block ends, however it does."""
        if self._armed is not None:
            raise NotArmed("the hand is armed already, in a block around this one")
        self._armed = limits = _limits(speed, force_g)
        try:
            self._disarmed = self._refused = None
            self._program.ask("arm", **limits)
            yield self
        finally:
            self._armed = None
            if not self._ended and self._program.is_own:
                self._program.ask("release")
        self._raise_refused()

    def _raise_refused(self) -> None:
        """Raises what was refused of what was sent and not waited for."""
        refused, self._refused = self._refused, None
        if refused is not None:
            raise refused

    def _may_move(self) -> None:
        self._program.check()
        if self._armed is None:
            raise NotArmed("nothing was moved: the hand moves only inside 'with hand.armed():'")
        if self._disarmed is not None:
            raise self._disarmed
        self._raise_refused()

    def _begin(self, angle: Mapping[Joint, Share], speed: Count, force_g: Count) -> Motion:
        six = [None if (at := angle.get(joint)) is None else _whole(joint, at, _NO_SHARE) for joint in JOINTS]
        # At rest, because what a hand holds is not known before.
        return self._motion("move", speed, force_g, angle=six, settle=True)

    def _motion(self, what: str, speed: Count, force_g: Count, **fields: Any) -> Motion:
        limits = _limits(speed, force_g)
        self._may_move()
        asked = self._program.begin(what, **fields, **limits)
        assert asked
        return Motion(self, asked)

    @overload
    def move(
        self, *, little: Count = ..., ring: Count = ..., middle: Count = ..., index: Count = ..., thumb_bend: Count = ...,
        thumb_rotate: Count = ..., speed: Count = ..., force_g: Count = ..., wait: Literal[True] = ..., **others: NoReturn,
    ) -> GripResult: ...  # fmt: skip

    @overload
    def move(
        self, *, little: Count = ..., ring: Count = ..., middle: Count = ..., index: Count = ..., thumb_bend: Count = ...,
        thumb_rotate: Count = ..., speed: Count = ..., force_g: Count = ..., wait: Literal[False], **others: NoReturn,
    ) -> Motion: ...  # fmt: skip

    def move(
        self, *, little: Count = None, ring: Count = None, middle: Count = None, index: Count = None, thumb_bend: Count = None,
        thumb_rotate: Count = None, speed: Count = None, force_g: Count = None, wait: bool = True, **others: NoReturn,
    ) -> Union[GripResult, Motion]:  # fmt: skip
        """Moves joints to these angles, 0 bent to 1000 open, and waits until the hand rests there, or something stops them:
        `hand.move(index=400, thumb_bend=600, speed=100)`. Other joints are left alone. Speed and force threshold are those of
        `armed`, unless they are named. With `wait=False` the script goes on at once, and `result()` waits."""
        joints = _joints(others, little, ring, middle, index, thumb_bend, thumb_rotate)
        motion = self._begin(joints, speed, force_g)
        return motion.result() if wait else motion

    def close_until(
        self, force_g: int, joints: Union[Joint, Sequence[Joint]] = CLOSING, *, to: int = 0, speed: Count = None
    ) -> GripResult:
        """Closes joints until each presses with about this force, or is at `to`; waits until the hand rests, and says what it
        holds. A force threshold acts late: the faster, the more a finger presses (`handscope help safety`)."""
        chosen: Sequence[Joint] = (joints,) if isinstance(joints, str) else joints
        _known(chosen)
        return self._begin({joint: to for joint in chosen}, speed, force_g).result()

    def pose(self, name: str, *, speed: Count = None, force_g: Count = None) -> GripResult:
        """Moves to a pose of the window's library, as `move` does: `hand.pose("Pinch")`. Upper or lower case is the same."""
        angles = self._program.ask("pose", name=name)["angle"]
        return self._begin(dict(zip(JOINTS, angles)), speed, force_g).result()

    def gesture(self, number: int, *, speed: Count = None, force_g: Count = None) -> GripResult:
        """Starts a gesture that the hand itself stores, 1 to 40, and waits for rest: that is `reached`, wherever it is."""
        return self._motion("gesture", speed, force_g, number=_whole("number", number)).result()

    def follow(
        self, *, little: Share = None, ring: Share = None, middle: Share = None, index: Share = None, thumb_bend: Share = None,
        thumb_rotate: Share = None, **others: NoReturn,
    ) -> None:  # fmt: skip
        """Sends a target to be followed, 0 bent to 1 open, and waits for nothing. For loops: without the next within 0.2 s the
        hand is held. How fast and how far ahead it goes is bounded (`handscope help stream`)."""
        joints = _joints(others, little, ring, middle, index, thumb_bend, thumb_rotate)
        self._may_move()
        self._program.tell({self._side: [joints[joint] for joint in JOINTS]})

    def stop(self) -> None:
        """Stops the hand, whoever moves it, and waits until it is seen to rest. An `armed()` block is over with it."""
        self._disarmed = Disarmed("this script stopped the hand: arm it again", "stop")
        self._program.ask("stop")

    def clear_faults(self) -> None:
        """Clears what drives report and can be cleared. That moves nothing; outside `armed()`."""
        self._program.ask("clear")

    def trial(self, joint: Union[str, Sequence[str]], **options: Any) -> list[Trial]:
        """Closes joints on an object and measures each grasp, as `handscope trial` does, with its options:
        `hand.trial("index", speed=[25, 250], force=500)`. Gives the trials."""
        told, why = self._command("trial", joint=joint, known_as=self.url, **options)
        if why:
            raise HandscopeError(why)
        return [one["trial"] for one in told if "trial" in one]

    def tune(self, joint: Union[str, Sequence[str]], limit: int, **options: Any) -> Tune:
        """Finds the fastest close that stays under a force, as `handscope tune` does. Without a result, `why` says why."""
        return _last(Tune, "tune", *self._command("tune", joint=joint, limit=limit, known_as=self.url, **options))

    def check(self, **options: Any) -> Check:
        """Checks an empty hand for wear, as `handscope check` does. It is not kept with the hand's earlier ones."""
        with tempfile.TemporaryDirectory() as folder:
            return _last(Check, "check", *self._command("check", **{"folder": folder, **options}))

    def grip_to(self, gap_mm: float, **options: Any) -> Gripped:
        """Closes thumb and index to a gap, as `handscope grip` does."""
        return _last(Gripped, "grip", *self._command("grip", gap=gap_mm, **options))

    def hold(
        self, for_s: float, *, put_down: Optional[Callable[[int], object]] = None, **options: Any
    ) -> Mapping[str, Any]:  # fmt: skip
        """Holds an object between two forces for this time, as `handscope hold` does, with its options:
        `hand.hold(10, pose="Power grasp", at_least=150, at_most=400)`. The hand keeps what it holds. A grasp of another hand is
        confirmed first if `put_down` is given: it is called with the number of a close once the load is gone, and returns once a
        person said that the object stands. Then the hand opens."""
        # The command reaches the hand over its shared one, and knows it by its own name.
        options = {"for": for_s, "known_as": self.url, **options}
        if put_down is None:
            return _last(dict, "hold", *self._command("hold", **options))
        says = put_down

        def answer(told: Mapping[str, Any]) -> bool:
            if asked := told.get("ask"):
                says(asked["close"])
            return bool(asked)

        return _last(dict, "hold", *self._command("hold", answer, **options, consent="stdin"))

    def _command(
        self, name: str, answer: Optional[Callable[[Mapping[str, Any]], bool]] = None, /, **options: Any
    ) -> tuple[list[Any], Optional[str]]:  # fmt: skip
        """Lets a command move the hand in this script's place, over the shared hand: what it told, and why it failed, if so."""
        self._may_move()
        self._program.ask("disarm")
        command = [name, "--hand", self.share_url, *_options(options), "--arm", "--json"]
        done = program.run(command) if answer is None else program.converse(command, answer)
        told = [json.loads(line) for line in done.lines]
        last = next(iter(told[-1].values())) if told else {}
        # A command that ran to its end says so, whatever it found.
        if done.why and not done.did_nothing and last.get("aborted", done) is not None:
            # It may have been stopped by a person, who is not overruled.
            self._disarmed = Disarmed(f"'{name}' ended early, and the hand is not armed any more: {done.why}", "ended")
        else:
            self._rearm()
        return told, done.why

    def _rearm(self) -> None:
        """Arms again after a command, whose end is known here a moment before the shared hand knows it."""
        until = time.monotonic() + _COMMAND_GONE_S
        while True:
            try:
                self._program.ask("arm", **(self._armed or {}))
                return
            except Taken as taken:
                if time.monotonic() > until:
                    self._disarmed = taken
                    raise
            time.sleep(0.02)

    def record(self, path: Union[str, "os.PathLike[str]"]) -> Recording:
        """Records everything from now on, until the block or the recording ends: `with hand.record("grasp.mcap"):`."""
        whole = os.path.abspath(path)
        self._program.ask("record", path=whole)
        return Recording(self, whole)

    def show(self) -> None:
        """Opens the window on the same hand. STOP works there, also while this script moves the hand; after it, a person can
        arm the hand there, and the script is told."""
        command = [self._program.path, "--hand", self.share_url]
        window = subprocess.Popen(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, **program.apart())
        try:
            _told, words = window.communicate(timeout=_WINDOW_OPENS_S)
        except subprocess.TimeoutExpired:
            self._windows.append(window)
            return
        raise HandscopeError(program.sentence(words.splitlines(), "the window was closed at once"))

    def close(self) -> None:
        """Disconnects: stops a hand that may move, and ends its program and its windows. No finger closes."""
        self._close()
        self._ended = "this hand was closed"

    def __enter__(self) -> "Hand":
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<handscope.Hand {self.url}>"


def _started(url: str, options: list[str], told: "weakref.WeakMethod[Any]") -> program.Program:
    """Starts the program of a hand, whose last name may be gone before it ends."""

    def tell(line: Mapping[str, Any]) -> None:
        if hear := told():
            hear(line)

    words = f"{url} is open in this script already: use that hand of handscope.hands(), or close() it first"
    shared = [hand.share_url for hand in hands()]
    # A simulated hand is another one each time.
    if any(url in (hand.url, hand.asked_url) for hand in hands() if not hand.simulated) and url not in shared:
        raise Refused(words, "open_already")
    try:
        return program.Program(options, tell)
    except HandscopeError as error:
        if any(f"(process {hand._program.pid})" in str(error) for hand in hands()):
            raise Refused(words, "open_already") from error
        raise


def _end(ended: program.Program, windows: "list[subprocess.Popen[str]]") -> None:
    """Ends what belongs to a hand, once."""
    ended.close()
    for window in windows if ended.is_own else ():
        window.terminate()
        window.communicate()


def _joints(others: Mapping[str, object], *six: Share) -> dict[Joint, Share]:
    _known(others)
    return dict(zip(JOINTS, six))


def _known(joints: Iterable[str]) -> None:
    if unknown := set(joints) - set(JOINTS):
        raise ValueError(f"{unknown.pop()!r} is not a joint: choose {', '.join(JOINTS)}")


# An angle of `follow` is refused by `move`: rounded, it would be a fist.
_NO_SHARE = "; move() takes whole numbers from 0, bent, to 1000, open, and follow() takes 0 to 1"


def _whole(name: str, value: float, more: str = "") -> int:
    if isinstance(value, bool) or not isinstance(value, numbers.Real) or not float(value).is_integer():
        raise Refused(f"nothing was moved: {name}={value!r} is not a whole number{more}", "wrong")
    return int(value)


def _limits(speed: Count, force_g: Count) -> dict[str, Count]:
    limits = {"speed": speed, "force_g": force_g}
    return {name: None if value is None else _whole(name, value) for name, value in limits.items()}


def _options(options: Mapping[str, Any]) -> list[str]:
    """Keywords as options of the command line: `max_temp=60` is `--max-temp 60`."""
    words: list[str] = []
    for name, value in options.items():
        if value is not None and value is not False:
            listed = ",".join(map(str, value)) if isinstance(value, (list, tuple)) else str(value)
            words += ["--" + name.replace("_", "-")] + [listed] * (value is not True)
    return words


def _last(of: type[Told], key: str, told: list[Any], why: Optional[str]) -> Told:
    for one in reversed(told):
        if key in one:
            return cast(Told, one[key])
    raise HandscopeError(why or f"'handscope {key}' told no result")

"""The program beside this package: where it is, and a conversation with it by lines of JSON (`handscope help share`)."""

from __future__ import annotations

import itertools
import json
import logging
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import threading
import weakref
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence

from .errors import HandscopeError, ProgramNotFound, of

LINES_VERSION = 1  # That of the lines that are spoken here.

_log = logging.getLogger("handscope")
_children: "weakref.WeakSet[subprocess.Popen[str]]" = weakref.WeakSet()
_NAME = "handscope.exe" if os.name == "nt" else "handscope"
_WITHIN_S = 30.0


def find() -> str:
    """The program: beside this package, then `$HANDSCOPE`, then on the path."""
    user = sysconfig.get_preferred_scheme("user") if sys.version_info >= (3, 10) else f"{os.name}_user"
    own = Path(__file__).parent.parent / "bin"  # pip install --target
    folders = sysconfig.get_path("scripts"), sysconfig.get_path("scripts", user), own
    for place in (Path(folder, _NAME) for folder in folders):
        if os.access(place, os.X_OK):
            return str(place)
    named = os.environ.get("HANDSCOPE") or shutil.which(_NAME)
    if named and os.access(named, os.X_OK):
        return named
    missing = "the program 'handscope' is not installed: the wheel of this package brings it, or name it in $HANDSCOPE"
    wrong = f"$HANDSCOPE names {named}, which is no program; unset it, or name the program 'handscope'"
    raise ProgramNotFound(wrong if named else missing)


class Ran(NamedTuple):
    """A command that was run to its end."""

    lines: List[str]
    why: Optional[str]  # Why it failed, if it did.
    did_nothing: bool  # It was used wrongly.


def run(arguments: Sequence[str]) -> Ran:
    """Runs a command to its end. Ctrl-C ends it as in a terminal."""
    child = _start([find(), *arguments], subprocess.DEVNULL)
    try:
        told, words = child.communicate()
    except BaseException:
        child.terminate()  # taken as Ctrl-C: the hand is stopped first
        child.communicate()
        raise
    return _ran(arguments, child.returncode, told.splitlines(), words.splitlines())


def converse(arguments: Sequence[str], answer: Callable[[Mapping[str, Any]], bool]) -> Ran:
    """Runs a command to its end, and answers it: after each line of JSON for which `answer` returns True, a line is entered."""
    child = _start([find(), *arguments], subprocess.PIPE)
    assert child.stdin and child.stdout and child.stderr
    words: List[str] = []
    listener = threading.Thread(target=words.extend, args=(child.stderr,), daemon=True)
    listener.start()
    told: List[str] = []
    try:
        for line in child.stdout:
            told.append(line.rstrip("\n"))
            if answer(json.loads(line)):
                child.stdin.write("\n")
                child.stdin.flush()
        child.wait()
    except BaseException:
        child.terminate()  # taken as Ctrl-C: the hand is stopped first
        raise
    finally:
        child.stdin.close()
        child.wait()
        listener.join(5.0)
        child.stdout.close()
    return _ran(arguments, child.returncode, told, words)


def _ran(arguments: Sequence[str], status: int, told: List[str], said: List[str]) -> Ran:
    why = sentence(said, f"'handscope {arguments[0]}' failed") if status else None
    for line in [] if why else said:
        _log.info("%s", line.rstrip("\n"))
    return Ran(told, why, status == 2)


def _start(command: Sequence[str], stdin: int) -> "subprocess.Popen[str]":
    pipe = subprocess.PIPE
    return subprocess.Popen(command, bufsize=1, stdin=stdin, stdout=pipe, stderr=pipe, text=True, encoding="utf-8", **apart())


def apart() -> Dict[str, Any]:
    """Ctrl-C is for the script, which stops the hand on its way out."""
    if os.name == "nt":
        return {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}  # type: ignore[attr-defined]
    return {"start_new_session": True}


def sentence(words: Sequence[str], otherwise: str) -> str:
    """The last thing that the program said, without its name."""
    said = [line.strip() for line in words if line.strip()]
    for line in reversed(said):
        if line.startswith('{"error":'):
            return str(json.loads(line)["error"]["message"])
        if line.startswith(("handscope: ", "error: ")):
            return line.split(": ", 1)[1]
    return said[-1] if said else otherwise


class Asked:
    """A request on its way to its answer."""

    def __init__(self, program: "Program", what: str) -> None:
        self._program = program
        self._what = what
        self.reply: Dict[str, Any] = {}

    def wait(self, timeout_s: Optional[float]) -> Mapping[str, Any]:
        """The answer; raises what went wrong."""
        program = self._program
        program.check()
        with program._answered:
            if not program._answered.wait_for(lambda: self.reply or program._ended, timeout_s):
                raise HandscopeError(f"the program did not answer '{self._what}' within {timeout_s} s", "no_answer")
        if "ok" not in self.reply:
            raise of(self.reply["kind"], self.reply["error"]) if self.reply else program._gone()
        done: Mapping[str, Any] = self.reply["ok"]
        return done


class Program:
    """One shared hand, in a process of its own. That process stops the hand when this one ends, however it does."""

    def __init__(self, arguments: Sequence[str], on_told: Callable[[Mapping[str, Any]], None]) -> None:
        self.path = find()  # Where the program is.
        self._on_told = on_told
        self._ids = itertools.count(1)
        self._lock = threading.Lock()
        self._asked: Dict[int, Asked] = {}
        self._owner = os.getpid()
        self._answered = threading.Condition()
        self._words: List[str] = []
        self.ready: Optional[Mapping[str, Any]] = None
        self._ended = False
        self._child = _start([self.path, "share", *arguments, "--stdio"], subprocess.PIPE)
        self.pid = self._child.pid
        # A forked worker must not keep the program's standard input open: it would outlive the script that moved the hand.
        _children.add(self._child)
        self._reader = threading.Thread(target=self._read, name="handscope", daemon=True)
        self._listener = threading.Thread(target=self._listen, name="handscope-words", daemon=True)
        self._listener.start()
        self._reader.start()
        try:
            with self._answered:
                self._answered.wait_for(lambda: self.ready or self._ended, _WITHIN_S)
            if self.ready and self.ready["v"] != LINES_VERSION:
                raise ProgramNotFound(self._other_version(str(self.ready["program"])))
        except BaseException:
            self.close()
            raise
        if not self.ready:
            self.close()  # then its exit status is known
            raise self._why_not()

    def _why_not(self) -> HandscopeError:
        """Why the program did not begin."""
        if self._child.returncode == 2 and any("--stdio" in line for line in self._words):
            told = subprocess.run([self.path, "--version"], capture_output=True, text=True).stdout
            version = re.search(r"\d+(\.\d+)+\S*", told)
            return ProgramNotFound(self._other_version(version.group() if version else "of an unknown version"))
        return HandscopeError(sentence(self._words, "the program 'handscope' terminated unexpectedly"))

    def _other_version(self, version: str) -> str:
        return f"the program at {self.path} is version {version}, which this package cannot speak to: install both from one wheel"

    def ask(self, what: str, timeout_s: Optional[float] = _WITHIN_S, **fields: Any) -> Mapping[str, Any]:
        """Asks one thing and waits for the answer. A callback of states runs where answers come in: there a stop goes out and is
        not waited for, and nothing else can be asked."""
        asked = self.begin(what, **fields)
        return asked.wait(timeout_s) if asked else {}

    def begin(self, what: str, **fields: Any) -> Optional[Asked]:
        """Asks one thing; nothing is to be waited for after a stop of a callback."""
        if threading.current_thread() is self._reader:
            if what != "stop":
                raise HandscopeError(f"a callback of on_state cannot ask for '{what}': it would wait for itself")
            self.tell({"do": what, **fields})
            return None
        own = next(self._ids)
        asked = self._asked[own] = Asked(self, what)
        self.tell({"id": own, "do": what, **fields})
        return asked

    def tell(self, line: Mapping[str, Any]) -> None:
        """Sends a line, and waits for nothing."""
        self.check()
        text = json.dumps(line, allow_nan=False) + "\n"
        try:
            with self._lock:
                assert self._child.stdin
                self._child.stdin.write(text)
                self._child.stdin.flush()
        except (OSError, ValueError):
            raise self._gone() from None

    @property
    def is_own(self) -> bool:
        """False in a process that was forked from the one that started the program."""
        return os.getpid() == self._owner

    def check(self) -> None:
        """Raises in a process that was forked from the one that started the program: what it sees is of before."""
        if not self.is_own:
            words = f"this hand belongs to process {self._owner}, from which this one was forked: open the hand here"
            raise HandscopeError(f"{words}, as with handscope.open(hand.share_url)", "other_process")

    def _gone(self) -> HandscopeError:
        return HandscopeError(sentence(self._words, "the program 'handscope' has ended"))

    def _read(self) -> None:
        assert self._child.stdout
        for line in self._child.stdout:
            if not line.endswith("\n"):
                break  # The program was killed within this line.
            told = json.loads(line)
            if "state" in told:
                self._on_told(told)
                continue
            with self._answered:
                if "ready" in told:
                    self.ready = told["ready"]
                reply = told.get("reply")
                asked = self._asked.pop(reply["id"], None) if reply else None
                if asked:
                    asked.reply.update(reply)
                self._answered.notify_all()
            self._on_told(told)
        self._listener.join(2.0)
        with self._answered:
            self._ended = True
            self._answered.notify_all()
        self._on_told({"ended": str(self._gone())})

    def _listen(self) -> None:
        assert self._child.stderr
        for line in self._child.stderr:
            self._words = [*self._words[-19:], line]
            if self.ready:
                _log.info("%s", line.strip())

    def close(self) -> None:
        """Ends the program, which stops a hand that may move, and waits for that."""
        if not self.is_own:
            return
        with self._lock:
            if self._child.stdin and not self._child.stdin.closed:
                try:
                    self._child.stdin.close()
                except OSError:
                    pass
        try:
            self._child.wait(_WITHIN_S)
        except subprocess.TimeoutExpired:
            self._child.kill()
            self._child.wait()
        if threading.current_thread() is not self._reader:
            self._reader.join(5.0)
            self._listener.join(5.0)
        for pipe, reads in ((self._child.stdout, self._reader), (self._child.stderr, self._listener)):
            # One that is still read would wait for its reader.
            if pipe and not reads.is_alive():
                pipe.close()


def _close_in_fork() -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for child in list(_children):
        for pipe in (child.stdin, child.stdout, child.stderr):
            if pipe and not pipe.closed:
                os.dup2(nothing, pipe.fileno())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_close_in_fork)

"""What can go wrong, in the program's own words."""

from __future__ import annotations

from typing import Optional


class HandscopeError(Exception):
    """Something could not be done; the message says what, why, and what to do, and `kind` in one word what it was."""
    kind = "failed"

    def __init__(self, message: str, kind: Optional[str] = None) -> None:
        super().__init__(message)
        if kind is not None:
            self.kind = kind


class ProgramNotFound(HandscopeError):
    """There is no program `handscope`, or not one of this package's version."""
    kind = "no_program"


class NotArmed(HandscopeError):
    """The hand was asked to move outside `with hand.armed():`. Nothing was moved."""
    kind = "not_armed"


class Disarmed(HandscopeError):
    """The script may no longer move the hand. `kind` says why: `stop`, `fault`, `silent`, `hot`, ..."""
    kind = "disarmed"


class Taken(Disarmed):
    """Another program moves the hand now, or took it from the script."""
    kind = "taken"


class LinkLost(Disarmed):
    """The hand does not answer any more. Nothing stops it: it may finish its move."""
    kind = "link_lost"


class Refused(HandscopeError):
    """The program or the hand did not take what was asked for. `kind` says why: `wrong`, `refused`, `replaced`, ..."""
    kind = "refused"


def of(kind: str, message: str) -> HandscopeError:
    """The exception for an answer of the program."""
    refused = dict.fromkeys(("refused", "wrong", "replaced", "not_confirmed"), Refused)
    types = {"not_armed": NotArmed, "taken": Taken, "link_lost": LinkLost, **refused}
    return types.get(kind, Disarmed)(message, kind)

"""What can go wrong, in the program's own words."""

from __future__ import annotations


class HandscopeError(Exception):
    """Something could not be done; the message says what, why, and what to do."""


class ProgramNotFound(HandscopeError):
    """There is no program `handscope`, or not one of this package's version."""


class NotArmed(HandscopeError):
    """The hand was asked to move outside `with hand.armed():`. Nothing was moved."""


class Disarmed(HandscopeError):
    """The script may no longer move the hand. `kind` says why: `stop`, `taken`, `fault`, `link_lost`, `hot`, ..."""

    def __init__(self, message: str, kind: str) -> None:
        super().__init__(message)
        self.kind = kind


class Taken(Disarmed):
    """Somebody else moves the hand now, or took it from the script."""


class LinkLost(Disarmed):
    """The hand does not answer any more. Nothing stops it: it may finish its move."""


class Refused(HandscopeError):
    """The program or the hand did not take what was asked for."""


def of(kind: str, message: str) -> HandscopeError:
    """The exception for an answer of the program."""
    if kind == "not_armed":
        return NotArmed(message)
    if kind == "taken":
        return Taken(message, kind)
    if kind == "link_lost":
        return LinkLost(message, kind)
    if kind in ("refused", "wrong", "replaced", "not_confirmed"):
        return Refused(message)
    return Disarmed(message, kind)

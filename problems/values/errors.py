"""The errors Grashof raises, all under `GrashofError`."""

from __future__ import annotations

import json
import re
import reprlib
from collections.abc import Sequence


class GrashofError(Exception):
    """Base of every error that Grashof raises on purpose."""


class ProblemError(GrashofError, ValueError):
    """Bad input: the message names the place, the value, and the values allowed."""


def wrong_value(where: str, value: object, wanted: str) -> ProblemError:
    """The error of a wrong value, with the values allowed."""
    return ProblemError(f"{where} is {shown(value)}; it must be {wanted}")


def listing(words: Sequence[object], last: str = "or") -> str:
    """Words in a sentence: a, b or c."""
    *most, end = map(str, words)
    return f"{', '.join(most)} {last} {end}" if most else end


def shown(value: object) -> str:
    """A value as messages show it: in Python, shortened."""
    text = " ".join(_SHORT.repr(value).splitlines())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 43]}...{text[-40:]}"


def shown_key(key: object) -> str:
    """A key as TOML has it, in quotes where it is not plain, and shortened."""
    text = str(key)
    text = text if len(text) <= _LONGEST_KEY else f"{text[:_LONGEST_KEY]}..."
    return text if re.fullmatch(r"[A-Za-z0-9_-]+", text) else json.dumps(text)


class _Short(reprlib.Repr):
    """Python's own, of values that a file may state."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlist = self.maxtuple = self.maxdict = 12
        self.maxstring, self.maxlong, self.maxother = 80, 60, 200

    def repr_int(self, x: int, level: int) -> str:
        # Python refuses to write thousands of digits, which hexadecimal numbers may have.
        if x.bit_length() > _LONGEST_INT:
            return f"a whole number of about {round(x.bit_length() * 0.30103)} digits"
        return super().repr_int(x, level)


_LONGEST_KEY = 60  # characters that messages show
_SHORT, _LONGEST, _LONGEST_INT = _Short(), 240, 10_000  # characters, bits


class AssemblyError(GrashofError):
    """A linkage cannot be assembled at a requested position."""


class NoSolutionError(GrashofError):
    """No verified design exists in a result; the message states why."""


class SolverError(GrashofError):
    """Environment error of a search: a worker died, an executor was lost."""


class GrashofWarning(UserWarning):
    """Base of every warning that Grashof gives on purpose."""


class DeadPositionWarning(GrashofWarning):
    """A dead position of the driver: links 3 and 4 would move infinitely fast there."""

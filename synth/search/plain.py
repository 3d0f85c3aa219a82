"""Value types of a search as JSON and back, to the last bit."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from types import UnionType
from typing import Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from grashof.analysis import Verdict
from grashof.analysis.judge.meeting.dwell_output import DwellFigures
from grashof.analysis.judge.meeting.two_outputs import TwoOutputs
from grashof.analysis.judge.verdict import Defect
from grashof.analysis.mechanism.first_loop import GrashofClass
from grashof.problems import Cylinder, Linkage, Objective, Problem, SixBar
from grashof.problems.values.linkages.mechanism import Dyad, DyadKind, Mechanism
from grashof.problems.values.linkages.mechanisms import CLASSES
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.second_loop import SecondLoop
from grashof.synth.programme.start import DrivenLinkage, Round, Start, Terms
from grashof.synth.quantities.kinds import kind_of
from grashof.synth.search.attempt import Attempt, Outcome
from grashof.synth.search.ledger import Chunk, Tally

# Types that may be written and read: values alone, so that a file is data.
TYPES: dict[str, Any] = {
    each.__name__: each
    for each in (
        *CLASSES.values(), Attempt, Candidate, Chunk, Cylinder, Defect, DrivenLinkage, Dyad, DwellFigures,
        Mechanism, Objective, Round, SecondLoop, Start, Tally, Terms, TwoOutputs, Verdict,
    )
}  # fmt: skip
WORDS: dict[str, Any] = {each.__name__: each for each in (DyadKind, GrashofClass, Outcome)}
# Known from elsewhere, or measured again.
_LEFT_OUT = {"Candidate": {"problem", "values"}, "Start": {"kind"}}
# NumPy's kinds of numbers: an integer is a real number, too, but True is not.
_NUMBERS = {int: "iu", float: "iuf", complex: "iufc", bool: "b"}
_SCALARS = (int, float, complex, np.generic)


def plain(value: Any) -> Any:
    """A value in JSON.

    Tuples become lists; every other type that JSON lacks becomes an object whose one key names it.

    >>> plain((1, 2j)), plain(np.array([0.5]))
    ([1, {'complex': [0.0, 2.0]}], {'array': ['<f8', [1], [0.5]]})
    """
    if isinstance(value, Enum):
        return {"word": [type(value).__name__, value.value]}
    if isinstance(value, np.generic):  # np.float64 is a float, too, but not only that
        return {"scalar": _plain_array(np.asarray(value))}
    if isinstance(value, np.ndarray):
        return {"array": _plain_array(value)}
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, complex):
        return {"complex": [value.real, value.imag]}
    if isinstance(value, tuple):
        return [plain(each) for each in value]
    if isinstance(value, list):
        return {"list": [plain(each) for each in value]}
    if isinstance(value, Counter):
        return {"counter": [[plain(key), number] for key, number in value.items()]}
    if isinstance(value, Mapping):
        return {"map": [[plain(key), plain(each)] for key, each in value.items()]}
    if isinstance(value, SixBar):  # its fields differ from mechanism to mechanism
        return {"SixBar": value.stated}
    if is_dataclass(value) and type(value).__name__ in TYPES:
        name = type(value).__name__
        left_out = _LEFT_OUT.get(name, set())
        named = {f.name: plain(getattr(value, f.name)) for f in fields(value) if f.name not in left_out}
        return {name: named}
    raise TypeError(f"{type(value).__name__} has no plain form")


def restored(value: Any, problem: Problem) -> Any:
    """The value of a plain form; designs are for `problem`.

    ValueError unless it is the plain form of a value whose fields have their types, and of no batch.

    >>> from grashof import load
    >>> restored(plain((1, 2j, float("inf"))), load("luggage"))
    (1, 2j, inf)
    """
    try:
        return _restored(value, problem)
    # The last two of numbers beyond 64 bits, and of lists nested a thousand deep.
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError, RecursionError) as error:
        raise ValueError(f"no plain form: {type(error).__name__}") from None


def _restored(value: Any, problem: Problem) -> Any:
    if isinstance(value, list):
        return tuple(_restored(each, problem) for each in value)
    if not isinstance(value, dict):
        return value
    ((name, content),) = value.items()
    if name == "complex":
        return complex(*content)
    if name in ("array", "scalar"):
        array = _restored_array(*content)
        return array[()] if name == "scalar" else array
    if name == "list":
        return [_restored(each, problem) for each in content]
    if name == "counter":
        return Counter({_restored(key, problem): number for key, number in content})
    if name == "map":
        return {_restored(key, problem): _restored(each, problem) for key, each in content}
    if name == "word":
        kind, word = content
        return WORDS[kind](word)
    if name == "SixBar":
        return _single(SixBar(**content))
    kind = TYPES[name]
    named = {key: _restored(each, problem) for key, each in content.items()}
    if kind is Start:
        named["kind"] = kind_of(problem)
    refuse_misfits(kind, named)
    if issubclass(kind, Linkage):
        _single(kind(**named))  # raises unless it is a linkage
    return Candidate(problem=problem, **named) if kind is Candidate else _made(kind, named)


def _single(linkage: Linkage) -> Linkage:
    if linkage.shape:
        raise ValueError("a batch of linkages")
    return linkage


def _made(kind: Any, named: dict[str, Any]) -> Any:
    """A value with its fields as they were, without its constructor."""
    made = object.__new__(kind)
    for each in fields(kind):
        object.__setattr__(made, each.name, named[each.name])
    return made


def _plain_array(array: np.ndarray[Any, Any]) -> list[Any]:
    flat = array.ravel()
    numbers = flat.astype(np.complex128).view(np.float64) if np.iscomplexobj(array) else flat
    return [array.dtype.str, list(array.shape), numbers.tolist()]


def _restored_array(dtype: str, shape: list[int], numbers: list[Any]) -> np.ndarray[Any, Any]:
    if np.dtype(dtype).kind not in "biufc":
        raise ValueError(f"an array of {dtype} is not one of numbers")
    if np.dtype(dtype).kind == "c":
        array = np.array(numbers, dtype=np.float64).view(np.complex128)
    else:
        array = np.array(numbers, dtype=dtype)
    array = array.reshape(shape)
    array.setflags(write=False)
    return array


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def refuse_misfits(kind: type, named: Mapping[str, Any]) -> None:
    """Raise `TypeError` unless values have the types of the fields of a dataclass that they name."""
    hints = _hints(kind)
    for name, value in named.items():
        if name not in hints or not fits(value, hints[name]):
            raise TypeError(f"{kind.__name__}.{name}")


def fits(value: Any, hint: Any) -> bool:
    """Whether a value is of an annotated type.

    >>> fits((1.0, 2), tuple[float, ...]), fits(True, int), fits(None, float | None)
    (True, False, True)
    >>> fits({"a": "b"}, dict[str, int])
    False
    """
    kind: Any = get_origin(hint) or hint
    parts = get_args(hint)
    if kind in (Union, UnionType):
        return any(fits(value, each) for each in parts)
    if kind in _NUMBERS:
        return isinstance(value, _SCALARS) and np.asarray(value).dtype.kind in _NUMBERS[kind]
    if kind is np.ndarray:
        return isinstance(value, (np.ndarray, np.generic))
    if kind is type(None) or not isinstance(value, kind):
        return value is None and kind is type(None)
    if kind is tuple and parts[1:] != (...,):
        return len(value) == len(parts) and all(map(fits, value, parts))
    if issubclass(kind, Mapping):
        key, each = (*parts, int)[:2]  # a Counter states its keys alone
        return all(fits(name, key) and fits(found, each) for name, found in value.items())
    return not parts or all(fits(each, parts[0]) for each in value)

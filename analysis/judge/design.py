"""A design as the user's own functions see it, on numbers and on CasADi symbols."""

from __future__ import annotations

import reprlib
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from threading import RLock
from traceback import clear_frames
from typing import Any, ParamSpec, TypeAlias, TypeVar

import numpy as np

from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import FourBar, Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, IntArray

P = ParamSpec("P")
T = TypeVar("T")
_LOCK = RLock()


@dataclass(frozen=True, slots=True)
class Design:
    """A linkage at its targets, in the problem's unit; numbers, or symbols in their place.

    Fields that its kind lacks are None: o4, r1 and r4 of a slider-crank, r3 and r4 of an inverted one, offset
    and slide_angle of a four-bar.

    Parameters
    ----------
    o2, o4 : two coordinates, length
        Ground pivots.
    r1, r2, r3, r4 : scalar, length
    theta1 : scalar, rad
        Direction O2->O4.
    coupler_point : two coordinates (u, v), length
    theta2 : N scalars, rad
        Driver angle at each target, in the order of visit.
    a, b, p : N times two coordinates, length
        Moving pivots and coupler point there.
    offset : scalar, length
    slide_angle : scalar, rad
    mechanism : str
        Its kind, such as "four-bar".
    """

    o2: Any
    o4: Any
    r1: Any
    r2: Any
    r3: Any
    r4: Any
    theta1: Any
    coupler_point: Any
    theta2: Any
    a: Sequence[Any]
    b: Sequence[Any]
    p: Sequence[Any]
    offset: Any = None
    slide_angle: Any = None
    mechanism: str = FourBar.mechanism.word

    @classmethod
    def of(cls, linkage: Linkage, theta2: FloatArray, assembly: IntArray) -> Design:
        """The numbers of a linkage at driver angles in the order of visit, shape (N,)."""
        state = solve_position(linkage, theta2, assembly)
        # Not Python's floats: (r1 - 5)**0.5 would be complex below 5.
        lengths = dict(zip(linkage.mechanism.lengths, linkage.lengths, strict=True))
        return cls(
            o2=linkage.o2,
            o4=getattr(linkage, "o4", None),
            **{name: lengths.get(name) for name in ("r1", "r2", "r3", "r4")},
            theta1=linkage.theta1,
            coupler_point=linkage.coupler_point,
            theta2=np.asarray(theta2),
            a=list(state.a),
            b=list(state.b),
            p=list(state.p),
            offset=getattr(linkage, "offset", None),
            slide_angle=getattr(linkage, "slide_angle", None),
            mechanism=linkage.mechanism.word,
        )

    @classmethod
    def judged(cls, linkage: Linkage, verdict: Verdict) -> Design:
        """The numbers of a linkage with its verdict."""
        visit = np.argsort(verdict.direction * verdict.theta2, kind="stable")
        return cls.of(linkage, verdict.theta2[visit], verdict.assembly[visit])


#: A constraint of your own: a function of a design, zero or negative where it is met; a scalar or several.
Constraint: TypeAlias = Callable[[Design], Any]
OwnObjective: TypeAlias = Callable[[Design], Any]  # smaller is better; a scalar


def one_at_a_time(function: Callable[P, T]) -> Callable[P, T]:
    """A function that may use CasADi, entered by one thread at a time: two in one solver crash.

    Its result must not hold anything of CasADi; an error that leaves it does not keep its symbols, which
    would otherwise end outside the lock.
    """

    @wraps(function)
    def alone(*args: P.args, **kwargs: P.kwargs) -> T:
        with _LOCK:
            handled = sys.exception()
            try:
                return function(*args, **kwargs)
            finally:
                _clear(sys.exception(), handled)

    return alone


def _clear(error: BaseException | None, handled: BaseException | None) -> None:
    """Clear the variables of the frames of an error, and of those it arose from since one was handled."""
    seen = {id(handled)}
    while error is not None and id(error) not in seen:
        seen.add(id(error))
        clear_frames(error.__traceback__)
        error = error.__cause__ or error.__context__


@one_at_a_time
def greatest(constraint: Constraint, design: Design, what: str = "constraint") -> float:
    """Greatest value of a constraint or objective; NaN when one is, ProblemError if they are not numbers."""
    with np.errstate(all="ignore"):  # where it has no value it is missed, without a warning
        values = constraint(design)
    try:
        return float(np.max(np.asarray(values, dtype=np.float64)))
    except (TypeError, ValueError):
        given = " ".join(reprlib.repr(values).split())
        raise ProblemError(
            f"{what} {name_of(constraint)} gives {given} on numbers; it must give a scalar or several"
        ) from None


def name_of(constraint: Constraint) -> str:
    """The name of a constraint in messages."""
    return getattr(constraint, "__name__", type(constraint).__name__)

"""What a user's own functions see of a design: the same names on numbers and on symbols."""

from __future__ import annotations

import reprlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from grashof.analysis.judge.one_at_a_time import one_at_a_time
from grashof.analysis.judge.verdict import Verdict
from grashof.analysis.mechanism.position import solve_position
from grashof.problems import FourBar, Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, IntArray


@dataclass(frozen=True, slots=True)
class Design:
    """A linkage at its targets, in the problem's unit; numbers, or the symbols that stand for them.

    What its kind has not is None: o4, r1 and r4 of a slider-crank, r3 and r4 of an inverted one, offset and
    slide_angle of a four-bar.

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


@one_at_a_time
def greatest(constraint: Constraint, design: Design, what: str = "constraint") -> float:
    """Greatest value of a constraint or objective; NaN when one is, ProblemError where not numbers."""
    with np.errstate(all="ignore"):  # where it has no value it is missed; no news to be warned of
        values = constraint(design)
    try:
        return float(np.max(np.asarray(values, dtype=np.float64)))
    except (TypeError, ValueError):
        given = " ".join(reprlib.repr(values).split())
        raise ProblemError(
            f"{what} {name_of(constraint)} gives {given} on numbers; it must give a scalar or several"
        ) from None


def name_of(constraint: Constraint) -> str:
    """What a constraint is called in messages."""
    return getattr(constraint, "__name__", type(constraint).__name__)

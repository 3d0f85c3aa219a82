"""The user's own constraints: are they usable, and which starts have to be mended for them."""

from __future__ import annotations

import pickle
from dataclasses import replace

import casadi as ca
import numpy as np

from grashof.analysis.design import Constraint, Design, greatest, name_of
from grashof.problems import ProblemError
from grashof.synth.setup import Setup
from grashof.synth.start import Start

NEAREST = 8  # starts that are tried for the closest miss
WRONG = (TypeError, ValueError, AttributeError, IndexError, KeyError, RuntimeError, NotImplementedError)


def refuse_unusable(setup: Setup, *, in_processes: bool) -> None:
    """Raise `ProblemError` for a constraint that cannot be used on symbols, or not in other processes."""
    for constraint in setup.constraints:
        if not callable(constraint):
            raise ProblemError(f"constraints has {constraint!r}; allowed are functions of a design")
        _try_on_symbols(constraint, len(setup.targets))
        if in_processes:
            try:
                pickle.dumps(constraint)
            except (pickle.PicklingError, AttributeError, TypeError) as error:
                raise ProblemError(
                    f"constraint {name_of(constraint)} cannot be sent to other processes ({error}); allowed "
                    "with workers are functions of a module"
                ) from None


def mended(setup: Setup, starts: list[Start]) -> list[Start]:
    """Starts, those that miss a user's constraint free to move, and no farther than it makes them."""
    if not setup.constraints:
        return starts
    return [
        start if _met(setup, start) else replace(start, radius=np.inf, stay=setup.exact, settled=False)
        for start in starts
    ]


def relaxed(setup: Setup, starts: list[Start]) -> list[Start]:
    """The first few starts, free to come as near to the user's constraints as they can."""
    if not setup.constraints:
        return []
    return [
        replace(start, radius=np.inf, stay=False, settled=False, relaxed=("constraints",))
        for start in starts[:NEAREST]
    ]


def _met(setup: Setup, start: Start) -> bool:
    design = _design(setup, start)
    return all(greatest(constraint, design) <= 0 for constraint in setup.constraints)


def _design(setup: Setup, start: Start) -> Design:
    a, b, p = (list(setup.frame.outward(track)) for track in start.track)
    r1, r2, r3, r4 = (length * setup.frame.scale for length in start.lengths)
    arm = start.arm * setup.frame.scale
    return Design(
        o2=setup.frame.outward(np.array(start.o2)),
        o4=setup.frame.outward(np.array(start.o4)),
        r1=r1,
        r2=r2,
        r3=r3,
        r4=r4,
        theta1=start.theta1,
        coupler_point=np.array([arm.real, arm.imag]),
        theta2=np.array(start.theta2),
        a=a,
        b=b,
        p=p,
    )


def _try_on_symbols(constraint: Constraint, targets: int) -> None:
    def point() -> ca.SX:
        return ca.SX.sym("point", 2)

    r1, r2, r3, r4, theta1 = (ca.SX.sym(name) for name in ("r1", "r2", "r3", "r4", "theta1"))
    a, b, p = ([point() for _ in range(targets)] for _ in range(3))
    theta2 = ca.SX.sym("theta2", targets)
    design = Design(point(), point(), r1, r2, r3, r4, theta1, point(), theta2, a, b, p)
    allowed = "allowed are functions of a design made of arithmetic that works on CasADi symbols"
    try:
        value = constraint(design)
        for one in value if isinstance(value, (list, tuple)) else [value]:
            parts = ca.vec(ca.SX(one))
            if any(parts[k].is_constant() and not parts[k].is_regular() for k in range(parts.numel())):
                raise ValueError("its value is not a number")  # float() of a symbol
    except WRONG as error:
        raise ProblemError(
            f"constraint {name_of(constraint)} fails on symbols: {error}; {allowed}"
        ) from error

"""The user's own functions: checks, values for linkages, and starts that miss them."""

from __future__ import annotations

import pickle
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np

from grashof.analysis.judge.design import Constraint, Design, OwnObjective, greatest, name_of, one_at_a_time
from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.specs.problem import NO_OBJECTIVE
from grashof.problems.values.text import counted
from grashof.synth.programme.start import Proposal, Start
from grashof.synth.quantities.kind import Kind
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened

FAR = 1e3  # in place of an unbounded amount
NEAREST = 8  # starts that are tried for the closest miss
# Operations whose value is a truth value; as a number, 1 where a condition holds.
_TRUTHS = (ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE, ca.OP_NOT, ca.OP_AND, ca.OP_OR)
# The place in CasADi's source with which its messages begin.
_PLACE = re.compile(r'^\S+\.[ch]pp:\d+: (Assertion ".*?" failed: )?')
WRONG = (TypeError, ValueError, AttributeError, IndexError, KeyError, RuntimeError, ArithmeticError)
_WARNS, _SILENT = 0, -1  # modes of CasADi for NumPy functions that meet symbols; what they do is the same


@dataclass(frozen=True, slots=True)
class _Kind:
    """A sort of function: its name, the meaning of its value, and whether it may have several values."""

    name: str
    value: str
    several: bool


_CONSTRAINT = _Kind("constraint", "zero or negative where it is met", several=True)
_OBJECTIVE = _Kind("objective", "smaller where the design is better", several=False)


def refuse_no_list(constraints: object) -> None:
    """Raise `ProblemError` where the user's constraints are not a list."""
    if isinstance(constraints, str) or not isinstance(constraints, Sequence):
        raise wrong_value("constraints", constraints, "a list of functions of a design")


def refuse_unusable(scaled: ScaledProblem, *, in_processes: bool) -> None:
    """Raise `ProblemError` for a function that cannot be used on symbols, or not in other processes."""
    for constraint in scaled.constraints:
        if not callable(constraint) or isinstance(constraint, type):
            raise ProblemError(f"constraints has {constraint!r}; they must be functions of a design")
        _refuse(scaled, constraint, _CONSTRAINT, in_processes)
    own = scaled.own_objective
    if own is None:
        return
    if not callable(own) or isinstance(own, type):
        raise wrong_value("objective", own, "a function of a design")
    if not scaled.problem.by_objective:
        raise ProblemError(NO_OBJECTIVE)
    _refuse(scaled, own, _OBJECTIVE, in_processes)


def _refuse(scaled: ScaledProblem, function: Constraint, kind: _Kind, in_processes: bool) -> None:
    _try_on_symbols(function, kind, scaled)
    if not in_processes:
        return
    try:
        pickle.dumps(function)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ProblemError(
            f"{kind.name} {name_of(function)} cannot be sent to other processes ({error}); with workers it "
            "must be a function of a module"
        ) from None


def own_violations(
    scaled: ScaledProblem, linkages: Screened, constraints: tuple[Constraint, ...]
) -> FloatArray:
    """Amounts by which linkages violate constraints; shape (n,)."""
    amounts = _values(scaled, linkages, constraints)
    missed: FloatArray = np.nan_to_num(np.maximum(amounts, 0.0), nan=1.0, posinf=FAR).sum(axis=0)
    return missed


def own_score(scaled: ScaledProblem, linkages: Screened, objective: OwnObjective) -> FloatArray:
    """Scores of linkages by the user's own objective, greater is better; shape (n,)."""
    score: FloatArray = np.nan_to_num(-_values(scaled, linkages, (objective,))[0], nan=-np.inf)
    return score


@one_at_a_time
def _values(scaled: ScaledProblem, linkages: Screened, functions: tuple[Constraint, ...]) -> FloatArray:
    """Values of functions for linkages, all evaluated at once, a row for each value."""
    design, symbols = _symbols(scaled.kind, len(scaled.targets))
    values = ca.vertcat(
        *(ca.vec(ca.SX(one)) for own in functions for one in _several(on_symbols(own, design)))
    )
    return np.asarray(ca.Function("own", [symbols], [values])(_numbers(scaled, linkages).T))


def _numbers(scaled: ScaledProblem, linkages: Screened) -> FloatArray:
    """The numbers of linkages in the order of `_symbols`, shape (n, M)."""
    o2, o4, a, b, p = linkages.points.T
    arm, lengths = (p - a) * np.abs(b - a) / (b - a), linkages.kind.dyad.lengths_of(o2, o4, a, b)
    columns = [
        *scaled.frame.outward(np.stack([o2, o4])).transpose(0, 2, 1).reshape(4, -1),
        *(np.broadcast_to(scaled.frame.scale * each, o2.shape) for each in lengths),
        linkages.kind.theta1_of(o2, o4, b),
        *(scaled.frame.scale * np.stack([arm.real, arm.imag])),
        *linkages.theta2.T,
        *scaled.frame.outward(linkages.track).transpose(0, 2, 3, 1).reshape(-1, len(linkages)),
    ]
    return np.stack(columns, axis=1)


def mended(scaled: ScaledProblem, starts: Sequence[Proposal]) -> Sequence[Proposal]:
    """Starts; those that miss a user's constraint may move, but no farther than it requires."""
    if not scaled.every_constraint:
        return starts
    return [
        start
        if not isinstance(start, Start) or _met(scaled, start)
        else start.under(radius=np.inf, stay=scaled.exact, settled=False)
        for start in starts
    ]


def relaxed_by_own(scaled: ScaledProblem, starts: Sequence[Proposal]) -> list[Start]:
    """The first few starts, free to miss the user's constraints by as little as possible."""
    if not scaled.constraints:
        return []
    return [
        start.under(radius=np.inf, stay=False, settled=False, relaxed=("constraints",))
        for start in starts[:NEAREST]
        if isinstance(start, Start)
    ]


def _met(scaled: ScaledProblem, start: Start) -> bool:
    design = _design(scaled, start)
    return all(greatest(constraint, design) <= 0 for constraint in scaled.every_constraint)


def magnitude_at(scaled: ScaledProblem, start: Start, objective: OwnObjective) -> float:
    """The magnitude of the user's own objective at a start, as its unit; 1 where it is zero or infinite."""
    magnitude = abs(greatest(objective, _design(scaled, start), "objective"))
    return magnitude if 1e-9 < magnitude < np.inf else 1.0


def _design(scaled: ScaledProblem, start: Start) -> Design:
    a, b, p = (list(scaled.frame.outward(track)) for track in start.track)
    arm = start.arm * scaled.frame.scale
    return Design(
        o2=scaled.frame.outward(np.array(start.o2)),
        o4=scaled.frame.outward(np.array(start.o4)) if "o4" in scaled.kind.linkage.mechanism.ground else None,
        **scaled.kind.named(np.array(start.lengths) * scaled.frame.scale, np.float64(start.theta1)),
        coupler_point=np.array([arm.real, arm.imag]),
        theta2=np.array(start.theta2),
        a=a,
        b=b,
        p=p,
    )


def _symbols(kind: Kind, targets: int) -> tuple[Design, ca.SX]:
    """A design of symbols, and all of these in one column."""
    o2, o4, arm = (ca.SX.sym(name, 2) for name in ("o2", "o4", "coupler_point"))
    lengths, theta1 = [ca.SX.sym(name) for name in ("r1", "r2", "r3", "r4")], ca.SX.sym("theta1")
    theta2 = ca.SX.sym("theta2", targets)
    a, b, p = ([ca.SX.sym(name, 2) for _ in range(targets)] for name in "abp")
    has_o4 = "o4" in kind.linkage.mechanism.ground
    named = kind.named(lengths, theta1)
    design = Design(
        o2=o2, o4=o4 if has_o4 else None, coupler_point=arm, theta2=theta2, a=a, b=b, p=p, **named
    )
    return design, ca.vertcat(o2, o4, *lengths, theta1, arm, theta2, *a, *b, *p)


def _several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, (list, tuple)) else [value]


@one_at_a_time
def _try_on_symbols(function: Constraint, kind: _Kind, scaled: ScaledProblem) -> None:
    design, _ = _symbols(scaled.kind, len(scaled.targets))
    try:
        value = on_symbols(function, design)
    except WRONG as error:
        reason = _PLACE.sub("", " ".join(str(error).split())).rstrip(".")
        if "truth value" in reason:
            reason += " (casadi.fmax, casadi.fmin and casadi.if_else do what max, min and if cannot)"
        raise ProblemError(
            f"{kind.name} {name_of(function)} fails on symbols: {reason}; it must be made of arithmetic "
            "that works on CasADi symbols"
        ) from error
    _refuse_no_amounts(f"{kind.name} {name_of(function)}", kind, value)


def _refuse_no_amounts(name: str, kind: _Kind, value: Any) -> None:
    """Raise `ProblemError` if the value of a function on symbols is not of its kind."""
    wanted = f"it must give a scalar, {kind.value}" + (", or a list of them" if kind.several else "")
    several = _several(value)
    for one in several:
        try:
            symbols = ca.SX(one)
        except WRONG:
            raise ProblemError(f"{name} gives {one!r}; {wanted}") from None
        if any(element.is_constant() and not element.is_regular() for element in symbols.nz):
            raise ProblemError(  # such as float() of a symbol
                f"{name} fails on symbols: its value is not a number; it must be made of "
                "arithmetic that works on CasADi symbols"
            )
        if isinstance(one, (bool, np.bool_)) or any(element.op() in _TRUTHS for element in symbols.nz):
            raise ProblemError(
                f"{name} gives a truth value; it must give a scalar, {kind.value}: a - b instead of a < b"
            )
    count = sum(ca.SX(one).numel() for one in several)
    if not count or (count > 1 and not kind.several):
        given = counted(count, "value") if count else "nothing"
        raise ProblemError(f"{name} gives {given}; {wanted}")


@contextmanager
def numpy_on_symbols() -> Iterator[None]:
    """NumPy functions give symbols of symbols, and do not warn."""
    # CasADi warns callers of NumPy functions on symbols that a later version may return arrays.
    # The mode is that of the process: it is restored, and left alone where it is not the default.
    options = ca.GlobalOptions
    if options.getNumpyMode() != _WARNS:
        yield
        return
    options.setNumpyMode(_SILENT)
    try:
        yield
    finally:
        options.setNumpyMode(_WARNS)


def on_symbols(constraint: Constraint, design: Design) -> Any:
    """The value of a constraint on the symbols of a design."""
    with numpy_on_symbols():
        return constraint(design)

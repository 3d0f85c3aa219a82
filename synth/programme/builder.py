"""A nonlinear programme put together: whatever enters it states how a start fills it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.long_programme import StopCondition, jacobian_by_rows
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import raise_if_stopped

# Numbers that a problem and a start give: as many as the symbols that they fill.
Fill: TypeAlias = Callable[[ScaledProblem, Start], Any]

ZERO, NONNEGATIVE = (0.0, 0.0), (0.0, np.inf)
FREE = (-np.inf, np.inf)


def always(low: float, high: float) -> Fill:
    """The same limits for every start."""
    return lambda _scaled, _start: (low, high)


_NOT_NEGATIVE = always(*NONNEGATIVE)


@dataclass(frozen=True, slots=True)
class _Unknown:
    symbol: ca.SX
    guess: Fill
    limits: Fill


@dataclass(slots=True)
class Builder:
    """Unknowns, parameters and rows, each declared once with the functions that fill them."""

    slack: ca.SX | None = None  # by which rows may be missed that a start gives up
    _unknowns: dict[str, _Unknown] = field(default_factory=dict)
    _parameters: list[tuple[ca.SX, Fill]] = field(default_factory=list)
    _rows: list[tuple[ca.SX, Fill]] = field(default_factory=list)
    _bounds: list[tuple[int, Fill]] = field(default_factory=list)

    def unknown(self, name: str, size: int, guess: Fill, limits: Fill) -> ca.SX:
        """An unknown, what a start guesses it to be, and its lower and upper limits."""
        symbol = ca.SX.sym(name, size)
        self._unknowns[name] = _Unknown(symbol, guess, limits)
        return symbol

    def parameter(self, value: Fill, size: int = 1) -> ca.SX:
        """Numbers that a start gives."""
        symbol = ca.SX.sym("p", size)
        self._parameters.append((symbol, value))
        return symbol

    def row(self, *expressions: ca.SX, limits: Fill = _NOT_NEGATIVE) -> None:
        """Rows with limits; not negative by default."""
        self._rows += [(expression, limits) for expression in expressions]

    def zero(self, *expressions: ca.SX) -> None:
        """Rows that have to be zero."""
        self.row(*expressions, limits=always(*ZERO))

    def require(self, parts: tuple[str, ...], *expressions: ca.SX) -> None:
        """Rows that must not be negative, but by the slack where a start gives one of the parts up."""
        if self.slack is not None:
            give = self.slack * self.parameter(lambda _, start: float(start.terms.gives(*parts)))
            expressions = tuple(expression + give for expression in expressions)
        self.row(*expressions)

    def require_if_given_up(self, parts: tuple[str, ...], *expressions: ca.SX) -> None:
        """Rows with slack in place of bounds that a start gives up."""
        if self.slack is not None:
            rows = (expression + self.slack for expression in expressions)
            self.row(*rows, limits=lambda _, start: NONNEGATIVE if start.terms.gives(*parts) else FREE)

    def bound(self, leaf: ca.SX, limits: Fill, *, gives: tuple[str, ...] = ()) -> None:
        """Limits of an unknown besides its own, unless a start gives one of the parts up."""
        hashes = [each.element_hash() for each in ca.vertsplit(self.unknowns)]
        held: Fill = lambda scaled, start: FREE if start.terms.gives(*gives) else limits(scaled, start)  # noqa: E731
        self._bounds.append((hashes.index(leaf.element_hash()), held))

    @property
    def unknowns(self) -> ca.SX:
        """All unknowns in one column."""
        return ca.vertcat(*(each.symbol for each in self._unknowns.values()))

    def stated(self, cost: ca.SX) -> dict[str, ca.SX]:
        """The programme that makes a cost least, as CasADi takes it."""
        return {
            "x": self.unknowns,
            "p": ca.vertcat(*(symbol for symbol, _ in self._parameters)),
            "f": cost,
            "g": ca.vertcat(*(expression for expression, _ in self._rows)),
        }

    def programme(self, cost: ca.SX, options: dict[str, Any], *, long: bool = False) -> Programme:
        """The programme that makes a cost least; a `long` one ends early by `StopRequested`."""
        stated = self.stated(cost)
        asking = StopCondition(stated) if long else None
        if long:
            raise_if_stopped()
            options = {**options, "jac_g": jacobian_by_rows(stated), "iteration_callback": asking}
            raise_if_stopped()
        sizes = {name: each.symbol.numel() for name, each in self._unknowns.items()}
        ends = np.cumsum(list(sizes.values())).tolist()
        return Programme(
            solver=ca.nlpsol("four_bar", "ipopt", stated, options),
            places={name: slice(end - sizes[name], end) for name, end in zip(sizes, ends, strict=True)},
            unknowns=tuple(self._unknowns.values()),
            parameters=tuple(value for _, value in self._parameters),
            rows=tuple((expression.numel(), limits) for expression, limits in self._rows),
            bounds=tuple(self._bounds),
            asking=asking,
        )


@dataclass(frozen=True, slots=True)
class Programme:
    """A programme built."""

    solver: ca.Function
    places: dict[str, slice]  # where each unknown stands in the column of all
    unknowns: tuple[_Unknown, ...]
    parameters: tuple[Fill, ...]
    rows: tuple[tuple[int, Fill], ...]
    bounds: tuple[tuple[int, Fill], ...]
    asking: StopCondition | None  # called by the solver of a long one, and kept for that

    def arguments(self, scaled: ScaledProblem, start: Start) -> dict[str, FloatArray]:
        """What the solver takes for a start."""
        given = [value(scaled, start) for value in self.parameters]
        low, high = self._unknown_limits(scaled, start)
        lbg, ubg = np.empty((2, sum(count for count, _ in self.rows)))
        end = 0
        for count, limits in self.rows:
            begin, end = end, end + count
            lbg[begin:end], ubg[begin:end] = limits(scaled, start)
        guess = np.concatenate([np.ravel(each.guess(scaled, start)) for each in self.unknowns])
        return {
            "x0": np.clip(guess, low, np.maximum(low, high)),
            "p": np.concatenate([np.ravel(each) for each in given]),
            "lbx": low,
            "ubx": high,
            "lbg": lbg,
            "ubg": ubg,
        }

    def _unknown_limits(self, scaled: ScaledProblem, start: Start) -> tuple[FloatArray, FloatArray]:
        low, high = np.empty((2, self.solver.size1_in("x0")))
        for each, column in zip(self.unknowns, self.places.values(), strict=True):
            low[column], high[column] = each.limits(scaled, start)
        for place, limits in self.bounds:
            least, most = limits(scaled, start)
            low[place], high[place] = max(low[place], least), min(high[place], most)
        return low, high

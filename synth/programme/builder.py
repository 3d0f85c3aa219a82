"""A nonlinear programme assembled from unknowns, parameters and rows, each with a function that fills it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import casadi as ca
import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.programme.start import Start
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.stopping import overdue, raise_if_stopped

# The numbers of a problem and a start that fill as many symbols.
Fill: TypeAlias = Callable[[ScaledProblem, Start], Any]

ZERO, NONNEGATIVE = (0.0, 0.0), (0.0, np.inf)
FREE = (-np.inf, np.inf)
FULL = 64  # unknowns: a row that depends on more of them is a full one
STOPPED = "User_Requested_Stop"  # Ipopt's return status


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

    slack: ca.SX | None = None  # amounts by which rows that a start relaxes may be missed
    _unknowns: dict[str, _Unknown] = field(default_factory=dict)
    _parameters: list[tuple[ca.SX, Fill]] = field(default_factory=list)
    _rows: list[tuple[ca.SX, Fill]] = field(default_factory=list)
    _bounds: list[tuple[int, Fill]] = field(default_factory=list)

    def unknown(self, name: str, size: int, guess: Fill, limits: Fill) -> ca.SX:
        """An unknown, its guess by a start, and its lower and upper limits."""
        symbol = ca.SX.sym(name, size)
        self._unknowns[name] = _Unknown(symbol, guess, limits)
        return symbol

    def parameter(self, value: Fill, size: int = 1) -> ca.SX:
        """Numbers from a start."""
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
        """Rows that must not be negative, except by the slack where a start relaxes one of the parts."""
        if self.slack is not None:
            give = self.slack * self.parameter(lambda _, start: float(start.terms.relaxes(*parts)))
            expressions = tuple(expression + give for expression in expressions)
        self.row(*expressions)

    def require_if_relaxed(self, parts: tuple[str, ...], *expressions: ca.SX) -> None:
        """Rows with slack in place of bounds that a start relaxes."""
        if self.slack is not None:
            rows = (expression + self.slack for expression in expressions)
            self.row(*rows, limits=lambda _, start: NONNEGATIVE if start.terms.relaxes(*parts) else FREE)

    def bound(self, leaf: ca.SX, limits: Fill, *, gives: tuple[str, ...] = ()) -> None:
        """Limits of an unknown besides its own, unless a start relaxes one of the parts."""
        hashes = [each.element_hash() for each in ca.vertsplit(self.unknowns)]
        held: Fill = lambda scaled, start: FREE if start.terms.relaxes(*gives) else limits(scaled, start)  # noqa: E731
        self._bounds.append((hashes.index(leaf.element_hash()), held))

    @property
    def unknowns(self) -> ca.SX:
        """All unknowns in one column."""
        return ca.vertcat(*(each.symbol for each in self._unknowns.values()))

    def stated(self, cost: ca.SX) -> dict[str, ca.SX]:
        """The programme that minimises a cost, as CasADi takes it."""
        return {
            "x": self.unknowns,
            "p": ca.vertcat(*(symbol for symbol, _ in self._parameters)),
            "f": cost,
            "g": ca.vertcat(*(expression for expression, _ in self._rows)),
        }

    def programme(self, cost: ca.SX, options: dict[str, Any], *, long: bool = False) -> Programme:
        """The programme that minimises a cost; a `long` one may raise `StopRequested`."""
        stated = self.stated(cost)
        callback = IterationCallback(stated) if long else None
        if long:
            raise_if_stopped()
            options = {**options, "jac_g": jacobian_by_rows(stated), "iteration_callback": callback}
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
            callback=callback,
        )


@dataclass(frozen=True, slots=True)
class Programme:
    """A programme built."""

    solver: ca.Function
    places: dict[str, slice]  # of each unknown in the column of all
    unknowns: tuple[_Unknown, ...]
    parameters: tuple[Fill, ...]
    rows: tuple[tuple[int, Fill], ...]
    bounds: tuple[tuple[int, Fill], ...]
    callback: IterationCallback | None  # called by the solver of a long one, and kept for that

    def arguments(self, scaled: ScaledProblem, start: Start) -> dict[str, FloatArray]:
        """Arguments of the solver for a start."""
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


def jacobian_by_rows(stated: Mapping[str, ca.SX]) -> ca.Function:
    """The rows ``g`` of a programme and their derivative by the unknowns ``x``, as Ipopt takes them."""
    x, p, g = (stated[name] for name in "xpg")
    row, _ = ca.jacobian_sparsity(g, x).get_triplet()
    # Unknowns that every target depends on and rows that depend on every target leave no two columns, and no
    # two rows, that can be differentiated together: all at once take time with the square of the targets. So
    # the few full rows are differentiated by themselves.
    full = np.bincount(np.array(row, dtype=np.int64), minlength=g.numel()) > FULL
    blocks = [np.flatnonzero(~full).tolist(), np.flatnonzero(full).tolist()]
    slope = ca.vertcat(*(ca.jacobian(g[rows], x) for rows in blocks))
    back = np.argsort(np.concatenate(blocks), kind="stable").astype(int).tolist()
    return ca.Function("nlp_jac_g", [x, p], [g, slope[back, :]], ["x", "p"], ["g", "jac_g_x"])


class IterationCallback(ca.Callback):
    """Called after every iteration of Ipopt; ends it when the search is overdue."""

    def __init__(self, stated: Mapping[str, ca.SX]) -> None:
        ca.Callback.__init__(self)
        counts = {name: stated[name].numel() for name in "xpg"}
        self._sizes = {"f": 1} | {of + name: count for name, count in counts.items() for of in ("", "lam_")}
        self.ended = False
        self.construct("asking", {})

    def get_n_in(self) -> int:
        """The number of results of a solve."""
        return int(ca.nlpsol_n_out())

    def get_n_out(self) -> int:
        """One: whether to end."""
        return 1

    def get_sparsity_in(self, place: int) -> ca.Sparsity:
        """Each result is a column."""
        return ca.Sparsity.dense(self._sizes[ca.nlpsol_out(place)], 1)

    def has_eval_buffer(self) -> bool:
        """Results are not copied for each call."""
        return True

    def eval_buffer(self, _given: Sequence[Any], answer: Sequence[Any]) -> int:
        """Answer 1 to end."""
        self.ended = overdue()
        memoryview(answer[0]).cast("b").cast("d")[0] = float(self.ended)
        return 0

    def ended_by_another(self, status: str) -> bool:
        """Whether a solve was ended by an interrupt during this call, which CasADi does not report."""
        return status == STOPPED and not self.ended

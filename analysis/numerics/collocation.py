"""Motions of one unknown under an acceleration that depends on position, speed and time, to many digits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.polynomial import legendre

from grashof.problems import SolverError
from grashof.problems.values.arrays import BoolArray, FloatArray

# A function of time, position, speed and a guess of the acceleration itself, shape (N,) each.
Acceleration = Callable[[FloatArray, FloatArray, FloatArray, FloatArray], FloatArray]
Events = Callable[[FloatArray, FloatArray], FloatArray]  # of position and speed, (N,), to (K, N)

_NODES = 16
_SWEEPS = 25
_DIFFERENCE = 1e-7
_GROWTH, _SHRINK, _STEEP, _CAREFUL = 4.0, 0.4, 0.1, 0.8
_SHORTEST = 1e-11  # share of the time: such a panel may hold a jump of the acceleration
_SAME = 1e-15  # share of the acceleration: smaller changes have settled
_MOST = 10_000  # panels: some five hundred turns


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """A time step from `start` (s): position and speed there, Legendre coefficients of the acceleration."""

    start: float
    length: float
    place: float
    speed: float
    terms: FloatArray

    @property
    def end(self) -> float:
        """Time at its end."""
        return self.start + self.length

    def at(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, speed and acceleration at times, shape (N,) each."""
        half = self.length / 2
        share, once = (time - self.start) / half - 1, legendre.legint(self.terms, lbnd=-1)
        twice = legendre.legint(once, lbnd=-1)
        place = self.place + self.speed * (time - self.start) + half**2 * legendre.legval(share, twice)
        speed = self.speed + half * legendre.legval(share, once)
        return np.asarray(place), np.asarray(speed), np.asarray(legendre.legval(share, self.terms))

    def last(self) -> tuple[float, float]:
        """Position and speed at its end."""
        place, speed, _ = self.at(np.array([self.end]))
        return float(place[0]), float(speed[0])


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """A motion in panels, and the event that ended it; None at the end of time."""

    panels: tuple[Panel, ...]
    event: int | None

    @property
    def end(self) -> float:
        """Time at its end."""
        return self.panels[-1].end

    def fastest(self) -> float:
        """The greatest absolute speed at nine times of each panel."""
        shares = np.linspace(0, 1, 9)
        speeds = [panel.at(panel.start + panel.length * shares)[1] for panel in self.panels]
        return float(np.abs(speeds).max())

    def at(self, time: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, speed and acceleration at times of the motion, shape (N,) each."""
        starts = np.array([panel.start for panel in self.panels])
        which = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(starts) - 1)
        found = np.empty((3, len(time)))
        for number in np.unique(which):
            here = which == number
            found[:, here] = self.panels[number].at(time[here])
        place, speed, acceleration = found
        return place, speed, acceleration


def integrate_motion(
    acceleration: Acceleration,
    start: float,
    end: float,
    place: float,
    speed: float,
    tolerance: float = 1e-12,
    events: Events | None = None,
    fastest: float = 0.0,
) -> Path:
    """The motion from a position and a speed until `end` (s) or until an event falls below zero.

    `acceleration` may be NaN where no motion exists, which no panel reaches. An event that is below zero at
    the start counts once it has been above. `tolerance` bounds the error of speed and position within a
    panel, as a share of their changes up to there and of `fastest`, the greatest earlier speed (rad/s).
    Collocation at 16 Gauss-Legendre points of each panel, of order 32 (Hairer, Lubich & Wanner, *Geometric
    Numerical Integration*, sec. II.1); the last terms of the polynomial estimate the error. SolverError if
    panels become too short.
    """
    span = end - start
    guess = float(acceleration(*(np.array([value]) for value in (start, place, speed, 0.0)))[0])
    if not np.isfinite(guess):
        raise SolverError("the motion could not be integrated: it has no acceleration at its start")
    length, panels, now = _first_length(span, speed, guess), list[Panel](), start
    armed = np.zeros(0, dtype=bool)
    if events is not None:
        armed = events(np.array([place]), np.array([speed]))[:, 0] > 0
    fastest, terms = max(fastest, abs(speed)), np.array([guess])
    while now < end:
        length = min(length, end - now)
        panel, error, sweeps = _panel(acceleration, now, length, place, speed, terms)
        scale = max(fastest, abs(speed), 1e-3 * span * float(np.abs(panel.terms).sum())) or 1.0
        share = error * length / (tolerance * scale)  # of the allowed error
        if not share <= 1 and length > _SHORTEST * span:
            length *= _SHRINK if not np.isfinite(share) else max(_STEEP, _CAREFUL * share ** (-1 / _NODES))
            continue
        if not np.isfinite(panel.terms).all():
            raise SolverError("the motion could not be integrated: its acceleration has no limit")
        panels.append(panel)
        if events is not None:
            met, armed = _event(panel, events, armed)
            if met is not None:
                return Path((*panels[:-1], _cut(panel, met[1])), met[0])
        if len(panels) > _MOST:
            raise SolverError(f"the motion could not be integrated: {_MOST} steps only reach {now:.3g} s")
        now, (place, speed) = panel.end, panel.last()
        fastest, terms = max(fastest, abs(speed)), np.array([float(panel.terms.sum())])
        length *= (
            min(_GROWTH, _CAREFUL * max(share, 1e-16) ** (-1 / _NODES)) if sweeps < _SWEEPS // 2 else 1.0
        )
        if end - now <= 4e-16 * max(abs(end), span):
            break
    return Path(tuple(panels), None)


def _first_length(span: float, speed: float, acceleration: float) -> float:
    """Length of a panel in which a motion in rad covers about a tenth of a turn."""
    lengths = [span]
    lengths += [0.6 / abs(speed)] if speed else []
    lengths += [np.sqrt(1.2 / abs(acceleration))] if acceleration else []
    return float(min(lengths))


def _integration() -> tuple[FloatArray, FloatArray, FloatArray]:
    """Nodes, the matrix from values to Legendre coefficients, and the matrix that integrates values."""
    nodes, weights = legendre.leggauss(_NODES)
    degrees = np.arange(_NODES)
    basis = legendre.legvander(nodes, _NODES - 1)
    to_terms = (basis * weights[:, None]).T * (degrees[:, None] + 0.5)
    integrated = np.stack(
        [legendre.legval(nodes, legendre.legint(row, lbnd=-1)) for row in np.eye(_NODES)], axis=-1
    )
    return np.asarray(nodes), np.asarray(to_terms), np.asarray(integrated @ to_terms)


_AT, _TO_TERMS, _INTEGRAL = _integration()
_BETWEEN = np.concatenate([[-1.0], (_AT[:-1] + _AT[1:]) / 2, [1.0]])


def _panel(
    acceleration: Acceleration, now: float, length: float, place: float, speed: float, terms: FloatArray
) -> tuple[Panel, float, int]:
    """A panel, the error of its acceleration, infinite without convergence, and the number of sweeps.

    Newton's method with derivatives by differences, which are kept while it converges.
    """
    half = length / 2
    time = now + half * (1 + _AT)
    found = np.broadcast_to(np.asarray(legendre.legval(_AT, terms), dtype=np.float64), _AT.shape)
    before, inverse = np.inf, None
    for sweep in range(1, _SWEEPS + 1):
        gained = half * (_INTEGRAL @ found)
        here, rate = place + speed * half * (1 + _AT) + half * (_INTEGRAL @ gained), speed + gained
        left = acceleration(time, here, rate, found) - found
        if inverse is None:
            inverse = _newton(acceleration, time, here, rate, found, half)
        change = inverse @ left
        found = found + change
        moved, size = float(np.abs(change).max()), float(np.abs(found).max())
        if not np.isfinite(moved):
            break
        if moved <= _SAME * size or (moved <= 1e-11 * size and moved >= 0.1 * before):
            panel = Panel(now, length, place, speed, _TO_TERMS @ found)
            rounding = 4e-16 * _NODES * float(np.abs(panel.terms).max())
            tail = float(np.abs(panel.terms[-3:]).max()) - rounding  # estimates the next terms
            return panel, max(tail, _defect(acceleration, panel)), sweep
        if moved > 0.5 * before and sweep > 4:
            break
        inverse = inverse if moved <= 0.05 * before or before == np.inf else None
        before = moved
    return Panel(now, length, place, speed, _TO_TERMS @ found), np.inf, _SWEEPS


def _newton(
    acceleration: Acceleration,
    time: FloatArray,
    place: FloatArray,
    speed: FloatArray,
    guess: FloatArray,
    half: float,
) -> FloatArray:
    """Inverse of the derivative of a panel's residual by its accelerations."""
    operands = np.stack([place, speed, guess])
    steps = _DIFFERENCE * np.maximum(1.0, np.abs(operands).max(axis=1))
    moved = operands[:, None] + np.concatenate([np.zeros((3, 1)), np.diag(steps)], axis=1)[..., None]
    values = acceleration(np.tile(time, 4), *moved.reshape(3, -1)).reshape(4, -1)
    by_place, by_speed, by_itself = ((values[1:] - values[0]) / steps[:, None])[..., None]
    integral = half * _INTEGRAL
    matrix = np.diag(1 - by_itself[:, 0]) - by_speed * integral - by_place * (integral @ integral)
    if not np.isfinite(matrix).all() or not abs(np.linalg.det(matrix)) > 0:
        return np.full(matrix.shape, np.nan)
    return np.linalg.inv(matrix)


def _defect(acceleration: Acceleration, panel: Panel) -> float:
    """Error of a panel's polynomial at its ends and halfway between its points."""
    time = panel.start + panel.length / 2 * (1 + _BETWEEN)
    place, speed, found = panel.at(time)
    off = np.abs(acceleration(time, place, speed, found) - found)
    rounding = 1e-13 * float(np.abs(found).max())
    return max(0.0, float(off.max()) - rounding) if np.isfinite(off).all() else np.inf


def _event(panel: Panel, events: Events, armed: BoolArray) -> tuple[tuple[int, float] | None, BoolArray]:
    """The first event in a panel with its time, if any, and the events armed at its end."""
    times = np.concatenate([[panel.start], panel.start + panel.length / 2 * (1 + _AT), [panel.end]])
    above = events(*panel.at(times)[:2]) > 0
    ever = np.logical_or.accumulate(above, axis=1) | armed[:, None]
    fallen = ever[:, :-1] & ~above[:, 1:]
    met = [
        (number, _crossing(panel, events, number, times[k], times[k + 1]))
        for number, k in enumerate(fallen.argmax(axis=1))
        if fallen[number, k]
    ]
    return min(met, key=lambda each: each[1], default=None), ever[:, -1]


def _crossing(panel: Panel, events: Events, number: int, low: float, high: float) -> float:
    """The time in a panel at which an event falls to zero."""

    def value(time: float) -> float:
        place, speed, _ = panel.at(np.array([time]))
        found = float(events(place, speed)[number, 0])
        return found if np.isfinite(found) else -1.0

    if not value(low) > 0:
        return low
    return float(scipy.optimize.brentq(value, low, high, xtol=1e-15 * max(abs(high), 1e-300), rtol=1e-14))


def _cut(panel: Panel, end: float) -> Panel:
    """The part of a panel before `end`."""
    length = max(end - panel.start, 1e-300)
    times = panel.start + length / 2 * (1 + _AT)
    return Panel(panel.start, length, panel.place, panel.speed, _TO_TERMS @ panel.at(times)[2])

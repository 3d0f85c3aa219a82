"""Designs that the judge accepted, verified over the entire motion by intervals of the driver angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from grashof.analysis.enclosure.closure import Least, Places, least_transmission, places
from grashof.analysis.enclosure.interval import EPS, Interval, crank, unit
from grashof.analysis.judge.measures import Values
from grashof.analysis.judge.meeting.task_motion import STEADY
from grashof.analysis.judge.missed_limits import SLACK
from grashof.analysis.judge.over_task import motion_ends
from grashof.analysis.judge.verdict import Enclosure, Verdict
from grashof.problems import Linkage, Requirements, Rotatability, Task
from grashof.problems.values.arrays import TURN, FloatArray
from grashof.problems.values.box import ANYWHERE
from grashof.problems.values.linkages.linkage import by_kind
from grashof.problems.values.requirements.function_ground import grounded

_AT_ONCE = 100  # linkages, so that memory is bounded
_OPEN = 1e-8  # share of the margins: an open loop, beyond the rounding of the judge


class _Shown(IntEnum):
    """Outcome of a claim; of several the worst counts."""

    TRUE = 0
    OPEN = 1
    FALSE = 2


class _Claim(NamedTuple):
    what: str
    shown: _Shown


_TWO_LOOPS = Enclosure(False, (0.0, np.pi / 2), 0, "closure of the second loop")
_UNJOINED = _Claim("a motion of link 2 through all targets", _Shown.OPEN)


def find_enclosures(designs: Sequence[Values]) -> tuple[Enclosure, ...]:
    """Enclose designs that the judge accepted, each once and for its own problem."""
    wanted = [each for each in designs if each.enclosure is None]  # of a list of kinds, several problems
    for problem in {id(each.problem): each.problem for each in wanted}.values():
        mine = [each for each in wanted if each.problem is problem]
        linkages, verdicts = zip(*((each.linkage, each.verdict) for each in mine), strict=True)
        found = enclose(linkages, problem.task, problem.requirements, verdicts)
        for each, enclosure in zip(mine, found, strict=True):
            each.enclosure = enclosure
    return tuple(each.enclosure for each in designs if each.enclosure is not None)


def enclose(
    linkages: Sequence[Linkage], task: Task, requirements: Requirements, verdicts: Sequence[Verdict]
) -> tuple[Enclosure, ...]:
    """Verify designs without defects by intervals about the verdicts' driver angles, a kind in one batch.

    Quantities are mean-value forms over an interval of the driver angle (Moore, Kearfott & Cloud,
    *Introduction to Interval Analysis*, ch. 6), rounded outward; limits have the slack that the judge grants,
    and driver angles and dimensions are the doubles listed. Left to the judge: outputs of functions, strokes,
    areas kept out, and all that does not depend on the driver angle.
    """
    task = grounded(task, requirements)
    wanted = requirements.for_task(task).resolved(task.size, scale_free=task.scale_free)
    found: dict[int, Enclosure] = {}
    for alike in by_kind(linkages):
        for begin in range(0, len(alike), _AT_ONCE):
            chosen = alike[begin : begin + _AT_ONCE]
            batch = [linkages[k] for k in chosen], [verdicts[k] for k in chosen]
            if len(batch[0][0].mechanism.loops) > 1:
                found |= dict.fromkeys(chosen, _TWO_LOOPS)
                continue
            found |= zip(chosen, _of_kind(*batch, task, wanted), strict=True)
    return tuple(found[k] for k in range(len(linkages)))


def _of_kind(
    linkages: list[Linkage], verdicts: list[Verdict], task: Task, wanted: Requirements
) -> Iterator[Enclosure]:
    """Each linkage twice: over the task motion, and over the turn if that is required."""
    full = wanted.rotatability is not Rotatability.ANY or task.closed
    cycle = wanted.transmission_over == "cycle"
    ends = np.array([motion_ends(task, verdict) for verdict in verdicts])
    if full or cycle:
        ends = np.concatenate([ends, ends[:, :1] + [0.0, TURN + 1e-14]])
    count = len(linkages)
    batch = linkages[0].stacked(linkages)
    over = batch[np.arange(len(ends)) % count]
    limited = np.arange(len(ends)) // count == int(cycle)
    required = np.where(limited, np.radians(wanted.transmission_min_deg) - SLACK, np.nan)
    least = least_transmission(over, ends[:, 0], ends[:, 1], required)
    theta2, sign = (np.stack([getattr(v, name) for v in verdicts]) for name in ("theta2", "assembly"))
    # Where all are at the targets, shape (linkages, targets).
    at = places(batch[:, None], sign.astype(np.float64), crank(theta2, np.zeros_like(theta2)))
    for k, verdict in enumerate(verdicts):
        row = count + k if cycle else k
        joined = verdict.branch_ok or full
        claims = [_closes(least, k, "the task motion")] if joined else [_UNJOINED]
        transmits = _compared(-least.hi[row], -least.lo[row], -required[row])
        if full:
            claims.append(_closes(least, count + k, "the turn"))
        claims += [
            *([_Claim("the transmission angle at its limit", transmits)] if joined or cycle else []),
            *_order(verdict, wanted),
            *_met(at, k, batch, task, wanted),
            *_boxed(at, k, task, wanted),
        ]
        undone = [claim for claim in claims if claim.shown is not _Shown.TRUE]
        yield Enclosure(
            holds=not undone,
            transmission=(float(least.lo[row]), float(least.hi[row])),
            intervals=int(least.pieces[k::count].sum()),
            why="; ".join(dict.fromkeys(claim.what for claim in undone)),
            contradicts=any(claim.shown is _Shown.FALSE for claim in claims),
        )


def _closes(least: Least, row: int, motion: str) -> _Claim:
    shown = _Shown.TRUE if least.lo[row] > 0 else _Shown.FALSE if least.gap[row] < -_OPEN else _Shown.OPEN
    return _Claim(f"closure without a dead position over {motion}", shown)


def _compared(lo: float, hi: float, most: float, beyond: float = 1e-12) -> _Shown:
    """Whether a number in [lo, hi] is at most `most`; false where it is more by over `beyond`, a rounding."""
    return _Shown.TRUE if hi <= most else _Shown.FALSE if lo > most + beyond else _Shown.OPEN


def _order(verdict: Verdict, wanted: Requirements) -> Iterator[_Claim]:
    if wanted.same_branch and np.ptp(verdict.assembly):
        yield _Claim("one assembly at all targets", _Shown.OPEN)
    if wanted.order:
        step = verdict.direction * np.diff(verdict.theta2)
        turned = abs(verdict.theta2[-1] - verdict.theta2[0])
        held = (step >= -2 * STEADY).all() and turned <= TURN + 2 * STEADY
        yield _Claim("the order of the targets", _Shown.TRUE if held else _Shown.FALSE)


def _met(at: Places, k: int, batch: Linkage, task: Task, wanted: Requirements) -> Iterator[_Claim]:
    """Positions and angles at the targets, as near as they must be."""
    exact, zones = wanted.is_exact(task), task.zones
    if not exact and zones is None:
        return
    allowed = np.full((2, len(task)), np.inf)
    if exact:
        most = wanted.tolerance * task.size
        allowed[:] = [[most], [most / task.angle_length]]
    if zones is not None:
        allowed = np.minimum(allowed, zones + SLACK * np.array([[task.size], [1.0]]))
    turn = task.angles - batch.body_angle[k]
    for what, miss, most, asked in (
        ("positions", _distance(at, k, task.positions), allowed[0], task.has_position),
        ("angles", _turned(at, k, turn), allowed[1], task.has_angle),
    ):
        if asked.any():
            each = map(_compared, miss.lo[asked], miss.hi[asked], most[asked], 1e-9 * most[asked])
            yield _Claim(f"the {what} of the targets at their tolerance", max(each))


def _distance(at: Places, k: int, positions: FloatArray) -> Interval:
    """Of P from the targets' positions."""
    x, y = (
        (part.mid.row(k) - Interval.of(positions[:, axis])).size for axis, part in enumerate((at.p.x, at.p.y))
    )
    return (x * x + y * y).root()


def _turned(at: Places, k: int, angle: FloatArray) -> Interval:
    """By how much link 3 is turned from an angle, rad, up to pi."""
    cos, sin = unit(angle, EPS * 4 * (np.abs(angle) + np.pi))
    c3, s3 = at.direction3.x.mid.row(k), at.direction3.y.mid.row(k)
    along, across = c3 * cos + s3 * sin, (s3 * cos - c3 * sin).size
    return Interval(
        np.arctan2(across.lo, along.hi) * (1 - 8 * EPS), np.arctan2(across.hi, along.lo) * (1 + 8 * EPS)
    )


def _boxed(at: Places, k: int, task: Task, wanted: Requirements) -> Iterator[_Claim]:
    """A and B in their boxes at every target."""
    for name, point in (("a", at.a), ("b", at.b)):
        box = getattr(wanted, name) or ANYWHERE
        for part, (low, high) in ((point.x, box.x), (point.y, box.y)):
            value, slack = part.mid.row(k), SLACK * task.size
            for most, least, limit in ((value.hi, value.lo, high), (-value.lo, -value.hi, -low)):
                if limit < np.inf:
                    beyond = 1e-12 * (abs(limit) + task.size)
                    each = (_compared(*pair, limit + slack, beyond) for pair in zip(least, most, strict=True))
                    yield _Claim(f"the box of {name.upper()}", max(each))

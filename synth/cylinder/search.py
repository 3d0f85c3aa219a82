"""The best cylinder on any link by search: samples, a closing-in search from the best, and a programme."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.cylinder.planes import Performance, Plane, Room, performance
from grashof.synth.cylinder.polish import Pivots, by_linear, by_quadratic
from grashof.synth.theory.stopping import overdue

_SAMPLES, _PARENTS, _CHILDREN, _ROUNDS = 6000, 48, 24, 24
_FIRST, _NARROWER = 0.25, 0.78  # share of the room that a step spans, and its factor after each round
_PENALTY = 10.0
_BLOCK = 500
_BEST, _APART = 2000, 0.12  # parents are among the best, and this far apart as a share of the room
_HOPELESS = -0.5  # a lower score cannot be repaired
_POLISHED, _AGAIN = 8, 3
# Cylinders polished to the end, and the repetitions of linear after quadratic programmes.
_FINISHED, _TURNS = 2, 2
_GAIN = 1e-9  # gain in the sine of the lever angle below which another programme is not worthwhile
COARSE, FINE = 4, 2  # steps between samples that suffice to compare, and to polish
_OVER = 0.15  # share of their box by which bases are drawn beyond it, then moved onto its sides
_MORE = 4  # times the samples, where a first search came near but found none
_SEEDS = 16  # times that each joint is tried


def best_by_search(plane: Plane, room: Room, seed: int) -> tuple[complex, complex, float] | None:
    """Pivot of the link, base, and the sine of the worst lever angle, of the best cylinder found.

    None where no sample, and nothing near one, drives the linkage within the limits.
    """
    rng = np.random.default_rng(seed)
    found, near = _searched(plane, room, 1, rng)
    if found is None and near:
        found, _ = _searched(plane, room, _MORE, rng)
    return found


def _searched(
    plane: Plane, room: Room, times: int, rng: np.random.Generator
) -> tuple[tuple[complex, complex, float] | None, bool]:
    """The best cylinder found, and where there is none, whether one came near."""
    points, bases = _drawn(plane, room, _SAMPLES * times, rng)
    coarse, fine = _thinned(plane, COARSE), _thinned(plane, FINE)
    score = np.concatenate([
        _score(room, performance(coarse, points[k : k + _BLOCK], bases[k : k + _BLOCK]))
        for k in range(0, len(points), _BLOCK)
    ])  # fmt: skip
    best = np.argsort(-score)[: _BEST * times]
    apart = _distinct(room, points[best], bases[best], _PARENTS * times, _APART)
    best = best[apart]
    points, bases, score = _closed_in(coarse, room, points[best], bases[best], score[best], rng)
    if score[0] < _HOPELESS:
        return None, False
    tried = [(complex(points[k]), complex(bases[k])) for k in _distinct(room, points, bases, _POLISHED)]
    tried += [by_quadratic(coarse, room, pair) for pair in tried if not overdue()]
    for _ in range(_AGAIN):  # it may continue from where it stopped
        tried += [by_quadratic(fine, room, pair) for pair in _best_of(fine, room, tried, 2) if not overdue()]
    for pair in _best_of(plane, room, tried, _FINISHED):  # between all samples
        tried += [] if overdue() else _finished(plane, room, pair)
    points, bases, least = _judged(plane, room, tried)
    first = int(least.argmax())
    if least[first] <= 0:
        return None, True
    return (complex(points[first]), complex(bases[first]), float(least[first])), True


def _judged(plane: Plane, room: Room, tried: list[Pivots]) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Cylinders moved to where they are allowed, and their least levers, negative beyond the limits."""
    points, bases = room.kept(*(np.array(each) for each in zip(*tried, strict=True)))
    found = performance(plane, points, bases)
    return points, bases, np.where(room.beyond(found) <= 0, found.least, -1.0)


def _finished(plane: Plane, room: Room, first: Pivots) -> list[Pivots]:
    """A cylinder after linear programmes (best where many limits are active) and quadratic ones (few)."""
    found = [by_linear(plane, room, first)]
    for programme in (by_quadratic, by_linear) * _TURNS:
        found.append(programme(plane, room, found[-1]))
        before, last = _judged(plane, room, found[-2:])[2]
        if not last > before + _GAIN:
            break
    return found


def _best_of(plane: Plane, room: Room, tried: list[Pivots], count: int) -> list[Pivots]:
    least = _judged(plane, room, tried)[2]
    return [tried[k] for k in np.argsort(-least, kind="stable")[:count]]


def _score(room: Room, found: Performance) -> FloatArray:
    return found.least - _PENALTY * room.beyond(found)


def _thinned(plane: Plane, step: int) -> Plane:
    """The plane at every `step`-th sample, and at the last."""
    kept = np.unique(np.append(np.arange(0, len(plane.axis), step), len(plane.axis) - 1))
    power, output = (None if each is None else each[kept] for each in (plane.power, plane.output))
    frame = {name: getattr(plane, name)[kept] for name in ("origin", "axis", "slide", "turn")}
    return replace(plane, **frame, power=power, output=output)


def _drawn(
    plane: Plane, room: Room, count: int, rng: np.random.Generator
) -> tuple[ComplexArray, ComplexArray]:
    """Random pivots: half of the bases anywhere in their box, and half about the chord of a point's way."""
    share, turn = rng.random((2, count))
    points = room.middle + room.reach * np.sqrt(share) * np.exp(2j * np.pi * turn)
    place = np.clip((1 + 2 * _OVER) * rng.random((2, count)) - _OVER, 0, 1)
    x, y = room.low[:, None] + (room.high - room.low)[:, None] * place
    own = np.repeat(room.joints, _SEEDS)[: count // 2]
    points[: len(own)] = own
    half, ends = count // 2, plane.origin[[0, -1]] + points[:, None] * plane.axis[[0, -1]]
    widest = float(np.hypot(*(room.high - room.low))) + room.reach
    shortest, longest = max(room.closed[0], 1e-3 * room.reach), min(room.closed[1], widest) * room.ratio
    length = shortest + max(longest - shortest, 0.0) * rng.random(half)
    base = x + 1j * y
    away = ends[:half, 0] - ends[:half, 1]
    aside = np.exp(0.5j * rng.standard_normal(half))
    aside[: len(own)] = 1.0
    base[:half] = ends[:half, 0] + length * aside * away / np.maximum(np.abs(away), 1e-300)
    mirrored = rng.random(half) < 0.5
    base[:half] = np.where(mirrored, ends[:half].sum(axis=1) - base[:half], base[:half])
    return room.kept(points, base)


def _closed_in(
    plane: Plane,
    room: Room,
    points: ComplexArray,
    bases: ComplexArray,
    score: FloatArray,
    rng: np.random.Generator,
) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Ever smaller random steps from each of some cylinders; the best of each family, best first."""
    span = room.high - room.low
    step, parents = _FIRST, np.arange(len(points))
    for _ in range(_ROUNDS):
        shape = (len(points), _CHILDREN)
        u, v, x, y = step * rng.standard_normal((4, *shape))
        tried_points = points[:, None] + room.reach * (u + 1j * v)
        tried_bases = bases[:, None] + span[0] * x + 1j * span[1] * y
        alone = rng.random(shape)  # one pivot alone, or both
        tried_points = np.where(alone < 0.25, points[:, None], tried_points)
        tried_bases = np.where(alone > 0.75, bases[:, None], tried_bases)
        kept = room.kept(tried_points.ravel(), tried_bases.ravel())
        found = _score(room, performance(plane, *kept)).reshape(shape)
        child = found.argmax(axis=1)
        better = found[parents, child] > score
        one, other = (each.reshape(shape)[parents, child] for each in kept)
        points, bases = np.where(better, one, points), np.where(better, other, bases)
        score = np.where(better, found[parents, child], score)
        step *= _NARROWER
    order = np.argsort(-score)
    return points[order], bases[order], score[order]


def _distinct(
    room: Room, points: ComplexArray, bases: ComplexArray, most: int, least: float = 0.02
) -> list[int]:
    """At most `most` cylinders, each at least `least` of the room from every better one, in their order."""
    close = least * (float(np.hypot(*(room.high - room.low))) + room.reach)
    kept, left = list[int](), np.arange(len(points))
    while len(left) and len(kept) < most:
        best = int(left[0])
        kept.append(best)
        left = left[np.abs(points[left] - points[best]) + np.abs(bases[left] - bases[best]) > close]
    return kept

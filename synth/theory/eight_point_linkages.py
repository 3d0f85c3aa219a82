"""All slider-cranks, and all inverted ones, whose coupler curve passes eight points.

The solutions that are known for general points (`eight_points`) are followed to the points asked
for. The real ones among them are linkages; each is closed at every point by its position formula.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from grashof.problems import InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dyad import Block, Slider, coupler_of
from grashof.synth.theory.eight_points import (
    INVERTED_SLIDER_CRANKS,
    SLIDER_CRANKS,
    Family,
)
from grashof.synth.theory.homotopy import corrected, follow

STEPS = 8000  # of a path: a few are long, and seldom lost for that
RUNS = 3  # with paths of their own, until all solutions are found
REAL = (
    1e-4  # so far from its mirror image, relative to itself, a real solution may come before it is made real
)
CLOSES = 1e-9  # largest miss of a point, sizes


AnyLinkage = TypeVar("AnyLinkage", SliderCrank, InvertedSliderCrank)


@dataclass(frozen=True, slots=True)
class Through(Generic[AnyLinkage]):
    """Linkages that pass eight points, in any order and branch."""

    linkages: AnyLinkage  # (n,); their directions are such that B lies ahead of A at the first point
    theta2: FloatArray  # (n, 8), rad: the driver at each point
    assembly: FloatArray  # (n, 8), +1 or -1 at each point
    solutions: int  # complex ones that were found, cognates as one


def slider_cranks_through(
    points: ComplexArray, rng: np.random.Generator, runs: int = RUNS
) -> Through[SliderCrank]:
    """All slider-cranks through eight distinct points (8,), each followed by its cognate.

    All but a path that is lost now and then, after at most `runs` times following all. `rng` turns the paths
    from the known solutions, so that they meet no singular point. The cognate has the same O2,
    A' = O2 + P - A and B' = O2 + k (B - O2) with k = w / r3: its crank turns with the coupler.
    """
    unknowns, turns, found = _real_solutions(SLIDER_CRANKS, points, rng, runs)
    r, _, o2, _, _, bs, s = unknowns.T
    a, b, along = o2 + r, bs.conj(), -1j * s**-0.5
    with np.errstate(divide="ignore", invalid="ignore"):
        k = -a / (b - a)  # P - A over B - A
        cognate = np.stack([o2, o2 - a, o2 + k * (b - o2), along * k / np.abs(k)])
        crank_turns = _cranks(o2, a, turns, points) / r[:, None]
    places = np.stack([np.stack([o2, a, b, along]), cognate]).transpose(2, 0, 1).reshape(-1, 4)
    return _slider_cranks(places, np.stack([turns, crank_turns], axis=1).reshape(-1, 8), points, found)


def inverted_slider_cranks_through(
    points: ComplexArray, rng: np.random.Generator, runs: int = RUNS
) -> Through[InvertedSliderCrank]:
    """All inverted slider-cranks through eight distinct points (8,), found as by `slider_cranks_through`."""
    unknowns, turns, found = _real_solutions(INVERTED_SLIDER_CRANKS, points, rng, runs)
    r, _, o2, _, o4, _, s = unknowns.T
    places = np.stack([o2, o2 + r, o4, -1j * s**-0.5], axis=1)
    return _inverted_slider_cranks(places, turns, points, found)


def solutions_at(
    family: Family, displacements: ComplexArray, rng: np.random.Generator, runs: int = RUNS
) -> ComplexArray:
    """Solutions (m, 7) for the displacements (14,) of real points, complex ones and all.

    The latter half of the displacements is conjugate to the former: so the mirror image of a solution is one,
    too, and finds it where its own path was lost. All paths are followed at most `runs` times, on ways of
    their own: what one has lost another finds.
    """
    start, known = family.known()
    found = known[:0]
    for _ in range(runs):
        factors = np.exp(rng.normal(0, 0.2, 2) + 1j * rng.uniform(0, 2 * np.pi, 2))
        ends, reached = follow(
            family.system,
            family.turned(known, factors),
            start * np.repeat(factors, 7),
            displacements,
            steps=STEPS,
        )
        ends = np.concatenate([ends[reached], family.mirrored(ends[reached])])
        ends = family.refined(ends, displacements)
        _, determined = family.turns(ends, displacements)
        found = family.distinct(np.concatenate([found, ends[determined]]))
        if len(found) >= family.count:
            break
    return found


def _real_solutions(
    family: Family, points: ComplexArray, rng: np.random.Generator, runs: int
) -> tuple[ComplexArray, ComplexArray, int]:
    """Real solutions, in sizes from the first point, shape (n, 7); the coupler's turns, (n, 8); all found."""
    steps = (points[1:] - points[0]) / _size(points)
    displacements = np.concatenate([steps, steps.conj()])
    found = solutions_at(family, displacements, rng, runs)
    gap = np.abs(found - family.mirrored(found)) / (np.abs(found) + 0.1)
    real = family.made_real(found[gap.max(axis=1) < REAL])
    turns, determined = family.turns(real, displacements)
    both = np.concatenate([real, turns], axis=1)[determined]
    for _ in range(4):
        both, _ = corrected(family.with_turns, both, np.broadcast_to(displacements, (len(both), 14)))
        both[:, :7] = family.made_real(both[:, :7])
        both[:, 7:] /= np.abs(both[:, 7:])
    both = both[np.isfinite(both).all(axis=1)]
    both = both[family.first_of_each(both[:, :7])]
    return both[:, :7], np.concatenate([np.ones((len(both), 1)), both[:, 7:]], axis=1), len(found)


def _slider_cranks(
    places: ComplexArray, turns: ComplexArray, points: ComplexArray, found: int
) -> Through[SliderCrank]:
    """Those that close.

    `places` (n, 4) are O2, A, B at the first point, in sizes from it, and the slide's direction; `turns` are
    (n, 8), `points` (8,).
    """
    o2, a, b, along = places.T
    rod = b - a
    r2, r3 = np.abs(a - o2), np.abs(rod)
    along = along * np.where((along.conj() * rod).real < 0, -1, 1)
    offset = (along.conj() * (b - o2)).imag
    theta2 = np.angle(_cranks(o2, a, turns, points))
    assembly = np.where(((along.conj() * rod)[:, None] * turns).real < 0, -1.0, 1.0)
    moved = r2[:, None] * np.exp(1j * theta2)
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = -a * rod.conj() / r3
        sizes = r3[:, None], offset[:, None], assembly
        _, e3 = coupler_of(Slider(), 1j * along[:, None], moved, *sizes)
        sound = _closes(o2[:, None] + moved + arm[:, None] * e3, points) & (r2 > 0)
    size = _size(points)
    linkages = SliderCrank(
        o2=_pair(points[0] + size * o2[sound]),
        r2=size * r2[sound],
        r3=size * r3[sound],
        offset=size * offset[sound],
        slide_angle=np.angle(along[sound]),
        coupler_point=_pair(size * arm[sound]),
        assembly=assembly[sound, 0],
        body_angle=np.zeros(np.count_nonzero(sound)),
    )
    return Through(linkages, theta2[sound], assembly[sound], found)


def _inverted_slider_cranks(
    places: ComplexArray, turns: ComplexArray, points: ComplexArray, found: int
) -> Through[InvertedSliderCrank]:
    """Those that close.

    `places` (n, 4) are O2, A, O4 at the first point, in sizes from it, and the rod's direction there; `turns`
    are (n, 8), `points` (8,).
    """
    o2, a, o4, along = places.T
    along = along * np.where((along.conj() * (o4 - a)).real < 0, -1, 1)
    r2, offset, arm = np.abs(a - o2), -(along.conj() * (o4 - a)).imag, -a * along.conj()
    cranks = _cranks(o2, a, turns, points)
    theta2, ground = np.angle(cranks), (o4 - o2)[:, None]
    ahead = ((along[:, None] * turns).conj() * (ground - cranks)).real
    assembly = np.where(ahead < 0, -1.0, 1.0)
    moved = r2[:, None] * np.exp(1j * theta2)
    with np.errstate(divide="ignore", invalid="ignore"):
        _, e3 = coupler_of(Block(), ground, moved, offset[:, None], offset[:, None], assembly)
        sound = _closes(o2[:, None] + moved + arm[:, None] * e3, points) & (r2 > 0)
    size = _size(points)
    linkages = InvertedSliderCrank(
        o2=_pair(points[0] + size * o2[sound]),
        o4=_pair(points[0] + size * o4[sound]),
        r2=size * r2[sound],
        offset=size * offset[sound],
        coupler_point=_pair(size * arm[sound]),
        assembly=assembly[sound, 0],
        body_angle=np.zeros(np.count_nonzero(sound)),
    )
    return Through(linkages, theta2[sound], assembly[sound], found)


def _cranks(o2: ComplexArray, a: ComplexArray, turns: ComplexArray, points: ComplexArray) -> ComplexArray:
    """From O2 to A at every point, shape (n, 8), in sizes."""
    return np.asarray((points - points[0]) / _size(points) + a[:, None] * turns - o2[:, None])


def _closes(p: ComplexArray, points: ComplexArray) -> BoolArray:
    """Which linkages have their coupler point, sizes from the first point, shape (n, 8), on all points."""
    missed = np.abs(p - (points - points[0]) / _size(points)).max(axis=1)
    closes: BoolArray = missed < CLOSES  # NaN where a loop does not close
    return closes


def _size(points: ComplexArray) -> float:
    return float(np.abs(points[:, None] - points).max())


def _pair(z: ComplexArray) -> FloatArray:
    return np.stack([z.real, z.imag], axis=-1)

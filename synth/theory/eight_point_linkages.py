"""All slider-cranks, and all inverted ones, whose coupler curve passes eight points.

They are the real ones among all solutions; each is closed at every point by its position formula.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from grashof.problems import InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.loop.dyad import Block, ClosingDyad, Slider, coupler_of
from grashof.synth.theory.homotopy import corrected
from grashof.synth.theory.point_families import INVERTED_SLIDER_CRANKS, SLIDER_CRANKS, Family
from grashof.synth.theory.solutions import RUNS, solutions_at

REAL = 1e-4  # distance of a real solution from its mirror image, relative to itself, before it is made real
CLOSES = 1e-9  # largest miss of a point, sizes

AnyLinkage = TypeVar("AnyLinkage", SliderCrank, InvertedSliderCrank)


@dataclass(frozen=True, slots=True)
class Through(Generic[AnyLinkage]):
    """Linkages that pass eight points, in any order and branch."""

    linkages: AnyLinkage  # (n,); their directions are such that B lies ahead of A at the first point
    theta2: FloatArray  # (n, 8), rad: the driver at each point
    assembly: FloatArray  # (n, 8), +1 or -1 at each point
    solutions: int  # number of complex ones found, cognates as one


def slider_cranks_through(
    points: ComplexArray, rng: np.random.Generator, runs: int = RUNS
) -> Through[SliderCrank]:
    """All slider-cranks through eight distinct points (8,), each followed by its cognate.

    All but a path that is lost now and then, after at most `runs` runs (see `solutions_at`). The cognate has
    the same O2, A' = O2 + P - A and B' = O2 + k (B - O2) with k = w / r3: its crank turns with the coupler.
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


def _real_solutions(
    family: Family, points: ComplexArray, rng: np.random.Generator, runs: int
) -> tuple[ComplexArray, ComplexArray, int]:
    """Real solutions, in sizes from the first point, shape (n, 7); the coupler's turns, (n, 8); all found."""
    steps = (points[1:] - points[0]) / _size(points)
    displacements = np.concatenate([steps, steps.conj()])
    found = solutions_at(family, displacements, rng, runs)
    gap = np.abs(found - family.mirrored(found)) / (np.abs(found) + 0.1)
    real = _made_real(family, found[gap.max(axis=1) < REAL])
    turns, determined = family.turns(real, displacements)
    both = np.concatenate([real, turns], axis=1)[determined]
    for _ in range(4):
        both, _ = corrected(family.with_turns, both, np.broadcast_to(displacements, (len(both), 14)))
        both[:, :7] = _made_real(family, both[:, :7])
        both[:, 7:] /= np.abs(both[:, 7:])
    both = both[np.isfinite(both).all(axis=1)]
    both = both[family.first_of_each(both[:, :7])]
    return both[:, :7], np.concatenate([np.ones((len(both), 1)), both[:, 7:]], axis=1), len(found)


def _made_real(family: Family, unknowns: ComplexArray) -> ComplexArray:
    """The real linkages nearby, shape (n, 7)."""
    real = (unknowns + family.mirrored(unknowns)) / 2
    real[:, 6] /= np.abs(real[:, 6])
    return (real + family.mirrored(real)) / 2


def _slider_cranks(
    places: ComplexArray, turns: ComplexArray, points: ComplexArray, found: int
) -> Through[SliderCrank]:
    """Those that close; `places` (n, 4): O2, A, B from the first point, in sizes; the slide's direction."""
    o2, a, b, along = places.T
    rod = b - a
    r3 = np.abs(rod)
    along = along * np.where((along.conj() * rod).real < 0, -1, 1)
    offset = (along.conj() * (b - o2)).imag
    assembly = np.where(((along.conj() * rod)[:, None] * turns).real < 0, -1.0, 1.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        arm = -a * rod.conj() / r3
    sizes = r3[:, None], offset[:, None], assembly
    theta2, sound, given = _closed(Slider(), 1j * along[:, None], sizes, (o2, a, arm), turns, points)
    size = _size(points)
    linkages = SliderCrank(
        **given, r3=size * r3[sound], offset=size * offset[sound], slide_angle=np.angle(along[sound])
    )
    return Through(linkages, theta2, assembly[sound], found)


def _inverted_slider_cranks(
    places: ComplexArray, turns: ComplexArray, points: ComplexArray, found: int
) -> Through[InvertedSliderCrank]:
    """Those that close; `places` (n, 4): O2, A, O4 from the first point, in sizes; the rod's direction."""
    o2, a, o4, along = places.T
    along = along * np.where((along.conj() * (o4 - a)).real < 0, -1, 1)
    offset, arm = -(along.conj() * (o4 - a)).imag, -a * along.conj()
    ground = (o4 - o2)[:, None]
    ahead = ((along[:, None] * turns).conj() * (ground - _cranks(o2, a, turns, points))).real
    assembly = np.where(ahead < 0, -1.0, 1.0)
    sizes = offset[:, None], offset[:, None], assembly
    theta2, sound, given = _closed(Block(), ground, sizes, (o2, a, arm), turns, points)
    size = _size(points)
    linkages = InvertedSliderCrank(
        **given, o4=_pair(points[0] + size * o4[sound]), offset=size * offset[sound]
    )
    return Through(linkages, theta2, assembly[sound], found)


def _closed(
    dyad: ClosingDyad,
    ground: ComplexArray,
    sizes: tuple[FloatArray, FloatArray, FloatArray],
    crank: tuple[ComplexArray, ComplexArray, ComplexArray],
    turns: ComplexArray,
    points: ComplexArray,
) -> tuple[FloatArray, BoolArray, dict[str, FloatArray]]:
    """Driver angles (m, 8) of the linkages that close on all points, their mask (n,) and common parameters.

    `ground` and `sizes`, the last of them the assembly, are as `coupler_of` takes them; `crank` is O2, A from
    the first point and AP in the frame of the coupler, each (n,).
    """
    o2, a, arm = crank
    r2, theta2, size = np.abs(a - o2), np.angle(_cranks(o2, a, turns, points)), _size(points)
    moved = r2[:, None] * np.exp(1j * theta2)
    with np.errstate(divide="ignore", invalid="ignore"):
        _, e3 = coupler_of(dyad, ground, moved, *sizes)
        missed = np.abs(o2[:, None] + moved + arm[:, None] * e3 - (points - points[0]) / size)
        sound = (missed.max(axis=1) < CLOSES) & (r2 > 0)  # NaN where a loop does not close
    given = {
        "o2": _pair(points[0] + size * o2[sound]),
        "r2": size * r2[sound],
        "coupler_point": _pair(size * arm[sound]),
        "assembly": sizes[2][sound, 0],
        "body_angle": np.zeros(np.count_nonzero(sound)),
    }
    return theta2[sound], sound, given


def _cranks(o2: ComplexArray, a: ComplexArray, turns: ComplexArray, points: ComplexArray) -> ComplexArray:
    """From O2 to A at every point, shape (n, 8), in sizes."""
    return np.asarray((points - points[0]) / _size(points) + a[:, None] * turns - o2[:, None])


def _size(points: ComplexArray) -> float:
    return float(np.abs(points[:, None] - points).max())


def _pair(z: ComplexArray) -> FloatArray:
    return np.stack([z.real, z.imag], axis=-1)

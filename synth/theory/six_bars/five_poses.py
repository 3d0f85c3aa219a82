"""Six-bars that carry a body exactly through five poses, best first."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from grashof.problems import Requirements, SixBar
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.problems.values.linkages.mechanism import Mechanism
from grashof.synth.theory.distinct import best_first
from grashof.synth.theory.six_bars.constructions import CONSTRUCTIONS, FourBars, Samples, SixBars
from grashof.synth.theory.six_bars.link_motions import POSES
from grashof.synth.theory.six_bars.screening import Screen, assemblies

REACH = 50.0  # sizes from the origin, of joints
STILL = 1e-9  # sizes: a point that moves less stands still


def six_bars_through(
    positions: ComplexArray,
    angles: FloatArray,
    wanted: Requirements,
    rows: Collection[Mechanism],
    rng: np.random.Generator,
    count: int = 2000,
) -> list[SixBar]:
    """Six-bars that meet five poses exactly, in order and in one motion without a dead position.

    Parameters
    ----------
    positions : ndarray of complex, shape (5,), sizes
        Of P, about the origin.
    angles : ndarray, shape (5,), rad
        Of the body.
    wanted : Requirements
        Resolved, in sizes. Met are those on rotatability, the transmission angle, link lengths and their
        ratio, arms of P, places of O2 and O4, rotation and sense of the driver; others are not looked at.
    rows : collection of Mechanism
        The kinds of six-bars allowed, each with the link that carries P: ``task.rows(word)``. Hosts (3, 1)
        with P on link 5; (2, 4), (2, 3) and (3, 4) with P on link 5 or 6.
    rng : numpy.random.Generator
    count : int
        Random chains of each construction: 2000 take 0.3 s.

    Returns
    -------
    list of SixBar
        The greatest worst transmission angle, over the motion for which it is required, first. Empty where
        two poses are equal, and where all are turned about one point, which a single pivot does.

    Raises
    ------
    ValueError
        Not five poses.

    Notes
    -----
    See `constructions`. Motions are sampled, with parabolas between samples; a judge has to confirm them.

    Examples
    --------
    >>> from grashof.problems import MotionTask
    >>> t = np.linspace(0, 1, 5)
    >>> task = MotionTask(np.stack([t, t * (1 - t)], axis=1), 1.2 * t)
    >>> wanted = Requirements(transmission_min_deg=40).for_task(task).resolved(1.0)
    >>> z, rows = task.positions @ [1, 1j], task.rows("watt-1")
    >>> found = six_bars_through(z, task.angles, wanted, rows, np.random.default_rng(0), 500)
    >>> len(found) > 0, {each.mechanism.word for each in found}
    (True, {'watt-1'})
    """
    if positions.shape != (POSES,) or angles.shape != (POSES,):
        raise ValueError(f"positions {positions.shape} and angles {angles.shape}: five poses are needed")
    if not (np.isfinite(positions) & np.isfinite(angles)).all():
        return []
    screen, found, scores = Screen(wanted), list[SixBar](), list[float]()

    def kept(loop: FourBars) -> BoolArray:
        return screen.loops(loop) | screen.loops(loop.reversed)

    with np.errstate(all="ignore"):  # chains that end in one point, bars without length: NaN, screened out
        samples = Samples.of(positions, angles, REACH, rng)
        if samples.motion.pole(STILL) is not None:
            return []
        for construct in CONSTRUCTIONS:
            for made in construct(samples, count, kept):
                for each in (made, made.reversed):
                    if each.row in rows:
                        good, sines = _screened(screen, each, samples.point)
                        found += linkages(good, samples.point, float(angles[0]))
                        scores += sines.tolist()
    return [found[k] for k in best_first(np.array(scores, dtype=np.float64))]


def _screened(screen: Screen, found: SixBars, point: complex) -> tuple[SixBars, FloatArray]:
    """Those that meet requirements, and sines of their transmission angles."""
    found = found[screen.loops(found.loop)]
    found = found[screen.second_loops(found, point)]
    sines = screen.transmission(found)
    good = np.isfinite(sines)
    return found[good], sines[good]


def linkages(found: SixBars, point: complex, angle: float) -> list[SixBar]:
    """As linkages, with P at `point` and the body at an angle, rad, at the first pose."""
    if not len(found):
        return []
    loop, (c, d), (_, r2, r3, r4, r5, r6) = found.loop, found.arms, found.lengths
    origin = found.c if found.carries == 5 else found.d
    along = found.e - origin
    first, second = assemblies(found)
    batch = SixBar(
        _xy(loop.o2), _xy(loop.o4), r2, r3, r4, c=_xy(c), d=_xy(d), r5=r5, r6=r6,
        coupler_point=_xy((point - origin) * np.conj(along / np.abs(along))),
        assembly=first,
        assembly_2=second,
        body_angle=np.angle(np.exp(1j * angle) * along.conj()),
        hosts=found.hosts,
        point_link=found.carries,
    )  # fmt: skip
    return [batch[k] for k in range(len(found))]


def _xy(places: ComplexArray) -> FloatArray:
    return np.stack([places.real, places.imag], axis=-1)

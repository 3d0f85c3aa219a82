"""Tasks of an output alone: dwells over several seeds, and strokes beside an independent search.

Dwells: the least band of a list, beside what a search of 2 s has to reach. Such a case fails where the median
band exceeds its limit, or a list has fewer than ten designs. Strokes: the best transmission angle under a
limit at one limit position that binds; a ratio is independent / ours. The independent search draws both limit
positions, O2 the origin and the rod 1, and SLSQP of scipy moves the best of many random ones; it shares no
formula with `grashof.synth`. Times are those of the processor, imports apart.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from time import process_time
from typing import Any

import numpy as np
from measuring import Case, timed
from scipy.optimize import minimize

from grashof import synthesize
from grashof.analysis import solve_position, verify
from grashof.problems import (
    Box,
    DwellTask,
    FourBar,
    Linkage,
    Problem,
    Requirements,
    SliderCrank,
    StrokeTask,
    TargetLimits,
)
from grashof.problems.values.arrays import FloatArray
from grashof.synth import Candidate

# Dwell, swing (0: a slide), transmission angle, deg; link ratio; least band, deg or as a share of the stroke.
LIMITS = (
    (60, 30, 40, 10, 0.002),
    (90, 45, 40, 10, 0.008),
    (90, 90, 30, 10, 0.02),
    (120, 60, 30, 10, 0.04),
    (180, 30, 30, 12, 0.2),
    (90, 0, 40, 10, 2e-4),
)
ENOUGH = 30  # designs: about two rounds


def problem_of(dwell: float, swing: float, mu: float, ratio: float) -> Problem:
    """The dwell of a swing, or of a slide with unit stroke."""
    way = {"swing_deg": swing} if swing else {"stroke": 1.0}
    wanted = Requirements(transmission_min_deg=mu, link_ratio_max=ratio)
    return Problem(task=DwellTask.from_degrees(dwell_deg=dwell, **way), requirements=wanted)


def least_bands(row: tuple[float, ...], count: int, seed: int) -> Iterator[str]:
    """Least bands, numbers of designs and times of `count` seeds."""
    *stated, most = row
    problem = problem_of(*stated)
    bands, found, times = [], [], []
    for number in range(seed, seed + count):
        result, seconds = timed(partial(synthesize, problem, seed=number, enough=ENOUGH), process_time)
        dwells = [one.verdict.dwell for one in result.candidates]
        scale = np.degrees(1.0) if row[1] else 1.0
        bands.append(min((scale * each.band for each in dwells if each is not None), default=np.inf))
        found.append(len(dwells))
        times.append(seconds)
    median = float(np.median(bands))
    sound = median <= most and min(found) >= 10
    yield (
        f"band median {median:.2g}, most {max(bands):.2g}, allowed {most:g}; designs from {min(found)}; "
        f"median {np.median(times):.2f} s{'' if sound else ' !'}"
    )


DRAWN, POLISHED = 8000, 30  # random members, and those of them that SLSQP moves
INSIDE = 2e-7  # distance of designs from their limits
WIDE = 0.02  # half the width of the boxes of the pivots


@dataclass(frozen=True, slots=True)
class Strokes:
    """Linkages with the swing or stroke of a problem, (n,) each; complex numbers are places.

    The unknowns (n, 5) are r2 / r3, logarithm of the rod, direction of O2A in the stretched position, O2. The
    driver turns counter-clockwise. `slow` is 1 where the slow stroke begins stretched, else -1; `side` is the
    side of B1B2 on which O4 lies, or the sense of the stroke from the stretched position along x.
    """

    problem: Problem
    x: FloatArray
    slow: int
    side: int

    @property
    def placed(self) -> dict[str, Any]:
        """Lengths, pivots, and A and B in the stretched and in the folded position, (n, 2)."""
        task = self.problem.task
        share, log_rod, turn, x, y = self.x.T
        lag = self.slow * np.pi * (task.time_ratio - 1) / (task.time_ratio + 1)
        if task.stroke is not None:  # along x, in either sense
            turn = -np.angle(self.side * ((1 - share) * np.exp(1j * lag) - 1 - share))
        ahead = np.exp(1j * (turn[:, None] + [0.0, lag]))
        b = np.stack([1 + share, 1 - share], axis=-1) * ahead
        chord = b[:, 1] - b[:, 0]
        rod = np.exp(log_rod) if task.stroke is None else task.stroke / np.abs(chord)
        o2 = (x + 1j * y)[:, None]
        half = np.tan((task.swing or 1.0) / 2)
        o4 = b.mean(axis=1) + 0.5j * self.side * chord / half  # the triangle O4-B1-B2 has equal sides
        a, b, chord, o4 = (rod.reshape(-1, *[1] * (each.ndim - 1)) * each for each in (
            np.stack([share, -share], axis=-1) * ahead, b, chord, o4,
        ))  # fmt: skip
        beside = (chord.conj() * b[:, 0]).imag / np.abs(chord)  # of the slide from O2
        return {
            "r1": np.abs(o4), "r2": share * rod, "r3": rod, "r4": np.abs(b[:, 0] - o4),
            "beside": np.abs(beside), "offset": self.side * beside,
            "along": chord / np.abs(chord), "o2": o2[:, 0], "o4": o2[:, 0] + o4, "a": o2 + a, "b": o2 + b,
        }  # fmt: skip

    def angles(self, at: dict[str, Any]) -> FloatArray:
        """Both transmission angles that may be the worst, (n, 2), rad."""
        if self.problem.task.stroke is not None:
            cosine = np.tile((at["r2"] + at["beside"]) / at["r3"], (2, 1))
        else:
            far = np.stack([at["r1"] - at["r2"], at["r1"] + at["r2"]])
            cosine = np.abs(at["r3"] ** 2 + at["r4"] ** 2 - far**2) / (2 * at["r3"] * at["r4"])
        found: FloatArray = np.arccos(np.clip(cosine, -1, 1)).T
        return found

    def room(self, at: dict[str, Any]) -> FloatArray:
        """Distances to the limits, (n, K); negative beyond them."""
        task = self.problem.task
        wanted = self.problem.requirements.resolved(task.size, scale_free=task.scale_free)
        coupler, names = at["b"] - at["a"], ("r2", "r3") if task.stroke else ("r1", "r2", "r3", "r4")
        if task.stroke is None:
            bars = at["r1"] + at["r2"] + at["r3"] + at["r4"]
            shorter, difference = at["r1"] - at["r2"], at["r3"] - at["r4"]
            turns = [at["r3"] + at["r4"] - at["r1"] - at["r2"], shorter - difference, shorter + difference]
            rows = [each / bars - wanted.rotatability_margin for each in turns]
            sides = (coupler.conj() * (at["b"] - at["o4"][:, None])).imag
        else:
            rows = [at["r3"] - at["r2"] - at["beside"]]
            sides = (coupler.conj() * at["along"][:, None]).real
        rows.append(
            sides.prod(axis=1) / (np.abs(sides).max(axis=1) ** 2 + 1e-300)
        )  # of one sign: one assembly
        lengths = np.stack([at[name] for name in names])
        rows.append(np.log(wanted.link_ratio_max) - np.log(lengths.max(axis=0) / lengths.min(axis=0)))
        if task.stroke is None:
            rows += within(at["o4"], wanted.o4)
        elif wanted.offset is not None:
            rows += [at["offset"] - wanted.offset[0], wanted.offset[1] - at["offset"]]
        rows += within(at["o2"], wanted.o2)
        for limits in wanted.at:
            for k in ((np.array(limits.targets) - 1) % 2).tolist():
                rows += self._at(at, limits, k if self.slow > 0 else 1 - k)
        return np.stack(rows, axis=-1) - INSIDE

    def _at(self, at: dict[str, Any], limits: TargetLimits, k: int) -> list[FloatArray]:
        """The same to those at one limit position, stretched (0) or folded (1)."""
        a, b = at["a"][:, k], at["b"][:, k]
        rows = within(a, limits.a) + within(b, limits.b)
        ends = {"o2": at["o2"], "o4": at["o4"], "a": a, "b": b}
        for name, (low, high) in limits.named.get("distances", {}).items():
            one, other = name.split("-")
            away = np.abs(ends[one] - ends[other])
            rows += [away - low, high - away]
        if limits.coupler_angle_deg is not None:
            low, high = np.radians(limits.coupler_angle_deg).tolist()
            rows.append((high - low) / 2 - np.abs(np.angle((b - a) * np.exp(-0.5j * (low + high)))))
        return rows

    def linkage(self) -> Linkage:
        """The first of them."""
        at = {name: each[0] for name, each in self.placed.items()}
        a, b, o2 = at["a"][0], at["b"][0], (at["o2"].real, at["o2"].imag)
        lengths = {name: float(at[name]) for name in ("r2", "r3", "r4")}
        if self.problem.task.stroke is None:
            side = int(np.sign(((b - a).conjugate() * (b - at["o4"])).imag))
            return FourBar(o2, (at["o4"].real, at["o4"].imag), **lengths, assembly=side)
        along = at["along"] * np.sign(((b - a).conjugate() * at["along"]).real)  # B ahead of A
        offset = float((along.conjugate() * (b - at["o2"])).imag)
        return SliderCrank(o2, lengths["r2"], lengths["r3"], offset, float(np.angle(along)))


def within(place: Any, box: Box | None) -> list[FloatArray]:
    """Distances (n,) of places to the sides of a box, inwards."""
    sides = [] if box is None else [(place.real, box.x), (place.imag, box.y)]
    return [(side * (value - end)) for value, both in sides for side, end in zip((1, -1), both, strict=True)
            if np.isfinite(end)]  # fmt: skip


def best_apart(problem: Problem, seed: int) -> float:
    """The best transmission angle of the independent search, rad; 0 where the judge accepts none."""
    rng, best = np.random.default_rng(seed), 0.0
    for slow in (1, -1) if problem.task.time_ratio > 1 else (1,):
        for side in (1, -1):
            for x in _drawn(problem, slow, side, rng):
                moved = Strokes(problem, _moved(problem, x, slow, side), slow, side)
                if not np.isfinite(moved.x).all() or moved.room(moved.placed).min() < -INSIDE:
                    continue
                verdict = verify(moved.linkage(), problem.task, problem.requirements)
                best = max(best, verdict.transmission_min_cycle if verdict.ok else 0.0)
    return best


def _drawn(problem: Problem, slow: int, side: int, rng: np.random.Generator) -> FloatArray:
    """The random members that miss limits by least, (POLISHED, 5): O4 near (1, 0)."""
    x = rng.uniform([0.01, -1, 0, -0.3, -0.3], [0.99, 1, 0, 0.3, 0.3], (DRAWN, 5))
    at = Strokes(problem, x, slow, side).placed
    ground = at["o4"] - at["o2"]  # is about 1 along x once turned and scaled
    x[:, 1] -= np.log(np.abs(ground)) + 0.2 * rng.normal(size=DRAWN)
    x[:, 2] -= np.angle(ground) + 0.3 * rng.normal(size=DRAWN)
    members = Strokes(problem, x, slow, side)
    at = members.placed
    score = members.angles(at).min(axis=1) + 10 * np.minimum(members.room(at), 0).sum(axis=1)
    found: FloatArray = x[np.argsort(-np.nan_to_num(score, nan=-np.inf))[::4][:POLISHED]]
    return found


def _moved(problem: Problem, x: FloatArray, slow: int, side: int) -> FloatArray:
    """A member of greatest transmission angle within the limits, (1, 5), by SLSQP from another (5,)."""

    def members(z: FloatArray) -> Strokes:
        return Strokes(problem, z[None, :5], slow, side)

    def room(z: FloatArray) -> FloatArray:
        some = members(z)
        at = some.placed
        return np.concatenate([some.angles(at)[0] - z[5], some.room(at)[0]])

    begun: FloatArray = np.append(x, members(x).angles(members(x).placed).min())
    bounds: Any = [(1e-3, 1 - 1e-3), (-5, 5), *[(None, None)] * 3, (0, np.pi / 2)]
    within: Any = {"type": "ineq", "fun": room}
    options: Any = {"maxiter": 200, "ftol": 1e-11}

    def negative(z: FloatArray) -> float:
        return -float(z[5])

    with np.errstate(all="ignore"):
        done = minimize(negative, begun, method="SLSQP", bounds=bounds, constraints=within, options=options)
    return np.asarray(done.x[None, :5])


def free_stroke(slides: bool, number: int) -> Candidate:
    """The best design of a random stroke whose pivots lie in boxes."""
    rng = np.random.default_rng([17, number])
    swing, ratio = float(rng.uniform(25, 100)), float(rng.uniform(1.0, 1.25))
    wide = 2 * WIDE if slides else WIDE
    o2, o4 = Box(x=(-wide, wide), y=(-wide, wide)), Box(x=(1 - WIDE, 1 + WIDE), y=(-WIDE, WIDE))
    if slides:
        task, kind = StrokeTask(stroke=1.0, time_ratio=ratio), "slider-crank"
        wanted = Requirements(o2=o2, slide_angle_deg=0.0, link_ratio_max=5.0, offset=(0, 5))
    else:
        task, kind = StrokeTask.from_degrees(swing_deg=swing, time_ratio=ratio), "four-bar"
        wanted = Requirements(o2=o2, o4=o4)
    return synthesize(Problem(task=task, requirements=wanted, mechanism=kind), seed=0).best


def _place(a: complex, b: complex, _: complex, rng: np.random.Generator) -> dict[str, Any]:
    """A square for A or B beside its best place."""
    name, at = (("a", a), ("b", b))[int(rng.integers(2))]
    middle, half = at + rng.uniform(0.17, 0.25) * np.exp(1j * rng.uniform(-np.pi, np.pi)), 0.15
    sides = ((float(each - half), float(each + half)) for each in (middle.real, middle.imag))
    return {name: Box(*sides)}


def _distance(a: complex, b: complex, o4: complex, rng: np.random.Generator) -> dict[str, Any]:
    """A distance of A from O4, or of B from O2 where O4 is none, away from the best one."""
    name, away = ("b-o2", abs(b)) if np.isnan(o4) else ("a-o4", abs(a - o4))
    factor = rng.uniform(1.02, 1.1)
    least, most = (away * factor, 1e6) if rng.random() < 0.5 else (0.0, away / factor)
    return {"distances": {name: (float(least), float(most))}}


def _heading(a: complex, b: complex, _: complex, rng: np.random.Generator) -> dict[str, Any]:
    """A direction of the coupler away from the best one."""
    angle = float(np.degrees(np.angle(b - a)))
    away, wide = float(rng.uniform(3, 8)), 50.0
    low = angle + away if rng.random() < 0.5 else angle - away - wide
    return {"coupler_angle_deg": (low, low + wide)}


LIMITED: dict[str, Callable[[complex, complex, complex, np.random.Generator], dict[str, Any]]] = {
    "place": _place,
    "distance": _distance,
    "coupler angle": _heading,
}


def limited_stroke(name: str, slides: bool, number: int) -> Problem:
    """A random stroke with a limit at a random limit position that binds."""
    free, rng = free_stroke(slides, number), np.random.default_rng([18, number])
    at, k = solve_position(free.linkage, free.verdict.theta2), int(rng.integers(2))
    o2 = complex(*free.linkage.o2)
    o4 = complex(np.nan) if slides else complex(*free.linkage.o4) - (o2 if name == "distance" else 0)
    a, b = (complex(*place[k]) - (o2 if name == "distance" else 0) for place in (at.a, at.b))
    limits = TargetLimits(targets=[k + 1], **LIMITED[name](a, b, o4, rng))
    return replace(free.problem, requirements=replace(free.problem.requirements, at=(limits,)))


def beside(name: str, slides: bool, count: int, seed: int) -> Iterator[str]:
    """The best transmission angles of strokes under limits beside those of the independent search."""
    ratios = []
    for number in range(seed, seed + count):
        problem = limited_stroke(name, slides, number)
        other, seconds = timed(partial(best_apart, problem, number), process_time)
        result, took = timed(partial(synthesize, problem, seed=0), process_time)
        ours = max((each.verdict.transmission_min_cycle for each in result.candidates), default=0.0)
        ratios.append(other / ours if ours else np.inf if other else np.nan)
        both = np.degrees([ours, other])
        yield f"{number}: {both[0]:.3f}, independent {both[1]:.3f} deg; {took:.1f} s and {seconds:.1f} s"
    known = np.array(ratios)[~np.isnan(ratios)]
    near = np.count_nonzero(known <= NEAR)
    worst = known.max(initial=0.0)
    yield (
        f"{near} of {len(known)} within {100 * (NEAR - 1):.0f} %, worst ratio {worst:.4f}; "
        f"better on {np.count_nonzero(known < 0.999)}{'' if near == len(known) else ' !'}"
    )


NEAR = 1.02
CASES = [
    *(
        Case("{:g} deg, {}, mu {:g}".format(row[0], f"swing {row[1]:g}" if row[1] else "slide", row[2]), 10,
             partial(least_bands, row))
        for row in LIMITS
    ),
    *(
        Case(f"{'stroke' if slides else 'swing'} beside an independent search: {name}", 10,
             partial(beside, name, slides))
        for name in LIMITED
        for slides in (False, True)
    ),
]  # fmt: skip

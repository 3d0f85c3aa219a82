"""Random batches of linkages of every kind, in any position and orientation."""

from __future__ import annotations

from typing import Any

import numpy as np
from body_coordinates import carried, follow, margins, rates, start
from body_plans import Array, plan_of

from grashof.problems import FourBar, InvertedSliderCrank, SixBar, SliderCrank
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.linkages.mechanisms import CLASSES

KINDS: tuple[Any, ...] = tuple(CLASSES.values())  # of one loop
# Seeds depend on the index: further rows follow these.
_FIRST = (
    "pins 2 3", "pins 3 4", "pins 2 1", "pins 4 1", "pins 2 4", "pins 3 1", "slide 4 1", "slide 3 1",
)  # fmt: skip
_EVERY = {
    f"{'slide' if dyad.slides else 'pins'} {dyad.hosts[0]} {dyad.hosts[1]}": (dyad.hosts, dyad.slides)
    for row in MECHANISMS
    for dyad in row.dyads[1:]
}
# Every six-bar: the links that carry C and D, and whether the second loop has a slide.
ROWS = {name: _EVERY[name] for name in dict.fromkeys((*_FIRST, *_EVERY))}
GRID: tuple[Any, ...] = (*KINDS, *ROWS)
TURN = np.linspace(0, 2 * np.pi, 73)


class Moving:
    """A batch of a kind at driver angles over a turn, by the judge; many are open at some of them."""

    def __init__(self, kind: Any, count: int, steps: int, driver: tuple[float, ...]) -> None:
        self.rng = rng = np.random.default_rng(GRID.index(kind))
        if kind in KINDS:
            some, theta = any_linkages(kind, 3 * count, rng), rng.uniform(-np.pi, np.pi, 3 * count)
            found = np.isfinite(start(plan_of(some), theta, 3, 40)).all(axis=-1)
            self.linkage, self.theta = some[found][:count], theta[found][:count]
        else:
            self.linkage, self.theta = six_bars(kind, count, rng), np.zeros(count)
        self.plan = plan_of(self.linkage)
        self.links = range(2, self.plan.moving + 2)
        self.q = start(self.plan, self.theta)
        self.turn = self.theta + np.linspace(-np.pi, np.pi, steps)[:, None]
        self.motion = rates(self.plan, follow(self.plan, self.q, self.theta, self.turn), *driver)
        self.clear = (np.abs(margins(self.plan, self.motion[0])) > 0.05).all(axis=-1)


def agree(found: Array, expected: Array, clear: Array, limit: float = 1e-9) -> None:
    """Assert agreement to a share of each linkage's greatest value, clear of dead positions."""
    apart, size = (
        np.where(clear, np.abs(values).reshape(*clear.shape, -1).max(axis=-1), 0.0)
        for values in (found - expected, expected)
    )
    assert (apart <= limit * np.maximum(size.max(axis=0), 1e-3)).all()


def any_linkages(kind: type[Any], count: int, rng: np.random.Generator) -> Any:
    """Linkages of one loop whose drivers turn or swing; some cannot be assembled at a given angle."""
    o2, point, assembly = rng.normal(size=(count, 2)), rng.normal(size=(count, 2)), rng.choice([-1, 1], count)
    o4, offset = o2 + 1.5 * rng.normal(size=(count, 2)), 0.5 * rng.normal(size=count)
    if kind is SliderCrank:
        r2, r3, angle = (rng.uniform(*ends, count) for ends in ((0.3, 1.5), (0.5, 3), (-np.pi, np.pi)))
        return SliderCrank(o2, r2, r3, offset, angle, point, assembly)
    if kind is InvertedSliderCrank:
        return InvertedSliderCrank(o2, o4, rng.uniform(0.3, 2, count), offset, point, assembly)
    return FourBar(o2, o4, *rng.uniform(0.4, 2.5, (3, count)), point, assembly)


def crank_rockers(count: int, rng: np.random.Generator) -> FourBar:
    """Four-bars whose drivers turn fully, most of them well away from dead positions."""
    o2, theta1, point = (
        rng.normal(size=(count, 2)),
        rng.uniform(-np.pi, np.pi, count),
        rng.normal(size=(count, 2)),
    )
    size, r2 = np.exp(rng.uniform(-1, 1, count)), rng.uniform(0.2, 0.8, count)
    total, apart = 1 + r2 + rng.uniform(0.1, 1.5, count), (1 - r2) * rng.uniform(-0.9, 0.9, count)
    o4 = o2 + (size * [np.cos(theta1), np.sin(theta1)]).T
    r3, r4 = size * (total + apart) / 2, size * (total - apart) / 2
    return FourBar(o2, o4, size * r2, r3, r4, size[:, None] * point, rng.choice([-1, 1], count))


def six_bars(row: str, count: int, rng: np.random.Generator, turning: bool = True) -> SixBar:
    """Six-bars of one of `ROWS` whose drivers turn fully; or many are stopped by the second loop."""
    (i, j), press = ROWS[row]
    first = crank_rockers(count, rng)
    size = first.r1[:, None]
    c, d = (size * rng.normal(0, 0.7, (count, 2)) + (first.o4 if host == 1 else 0) for host in (i, j))
    plan = plan_of(first)
    motion = rates(plan, follow(plan, start(plan, 0.0), 0.0, TURN))
    way_c = carried(motion, i, c)[0]
    shared = {
        name: getattr(first, name) for name in ("o2", "o4", "r2", "r3", "r4", "coupler_point", "assembly")
    }
    shared |= {"hosts": (i, j), "c": c, "assembly_2": rng.choice([-1, 1], count)}
    if press:
        angle = rng.uniform(-np.pi, np.pi, count)
        across = ((way_c - first.o2) * np.stack([-np.sin(angle), np.cos(angle)], axis=-1)).sum(axis=-1)
        offset = across.mean(axis=0) + 0.3 * first.r1 * rng.normal(size=count)
        shares = rng.uniform(1.05, 3, count) if turning else rng.uniform(0.7, 1.5, count)
        r5 = np.abs(across - offset).max(axis=0) * shares
        return SixBar(**shared, r5=r5, slide_angle_2=angle, offset_2=offset)
    apart = np.linalg.norm(carried(motion, j, d)[0] - way_c, axis=-1)
    least, most = apart.min(axis=0), apart.max(axis=0)
    if turning:
        total, more = most * rng.uniform(1.05, 2, count), least * rng.uniform(-0.9, 0.9, count)
    else:
        total, more = most * rng.uniform(0.75, 1.2, count), most * rng.uniform(-0.6, 0.6, count)
    return SixBar(**shared, d=d, r5=(total + more) / 2, r6=(total - more) / 2)


def swinging_six_bars(row: str, count: int, rng: np.random.Generator) -> tuple[SixBar, Array]:
    """Six-bars of one of `ROWS` whose first loops turn or swing; driver angles at which they close."""
    (i, j), press = ROWS[row]
    first = any_linkages(FourBar, 8 * count, rng)
    theta = rng.uniform(-np.pi, np.pi, 8 * count)
    plan = plan_of(first)
    q = start(plan, theta, guesses=30)
    found = np.flatnonzero(np.isfinite(q).all(axis=-1))[:count]
    first, theta, motion = first[found], theta[found], rates(plan.taken(found), q[found])
    c, d = (0.8 * rng.normal(size=(count, 2)) + (first.o4 if host == 1 else 0) for host in (i, j))
    at_c = carried(motion, i, c)[0]
    shared = {name: getattr(first, name) for name in ("o2", "o4", "r2", "r3", "r4", "assembly")}
    shared |= {"hosts": (i, j), "c": c, "assembly_2": rng.choice([-1, 1], count)}
    if press:
        angle, offset = rng.uniform(-np.pi, np.pi, count), 0.5 * rng.normal(size=count)
        left = np.stack([-np.sin(angle), np.cos(angle)], axis=-1)
        away = np.abs(offset - ((at_c - first.o2) * left).sum(axis=-1))
        r5 = away * rng.uniform(1.02, 2.5, count) + 0.05
        return SixBar(**shared, r5=r5, slide_angle_2=angle, offset_2=offset), theta
    apart = np.linalg.norm(carried(motion, j, d)[0] - at_c, axis=-1)
    total, more = apart * rng.uniform(1.02, 2, count), apart * rng.uniform(-0.98, 0.98, count)
    return SixBar(**shared, d=d, r5=(total + more) / 2, r6=(total - more) / 2), theta

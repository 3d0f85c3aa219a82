"""One side alone of a linkage through three poses: the tiles that may hold its dyad, or proof of none."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.proof.curve.dyads import lengths_of, possible_arms, possible_radii, roles_of, same_lengths
from grashof.synth.proof.curve.required import Dyad, Required
from grashof.synth.proof.curve.table import NOTHING, OPEN, TooMany
from grashof.synth.proof.forms.forms import Span
from grashof.synth.proof.poses.charts import GROUND, MOVING, Charts, Tiles
from grashof.synth.theory.burmester import Displacements
from grashof.synth.theory.stopping import raise_if_stopped

SQUARES = 8  # along the longer side of a rectangle that is covered
COARSE = 0.5  # length of first tiles, as a share of the local scale
TINY = 2e-4  # sizes: tiles of at most this size are not halved on their own
ENOUGH = 500  # approximate number of first tiles: those still too large are halved where pairs need it
MOST_TILES = 60_000  # examined for a side alone


@dataclass(frozen=True, slots=True)
class OneSide:
    """The requirements on the dyad of one side."""

    required: Required  # the requirements on both dyads that concern one alone
    is_driver: bool
    charts: Charts

    @classmethod
    def of(cls, required: Required, *, is_driver: bool) -> OneSide:
        """The side of the driver, or the other one."""
        dyad = required.driver if is_driver else required.driven
        motion = Displacements(required.curve.rotation, required.curve.shift)
        turn = np.exp(1j * required.first_turn)
        by_z = Charts.of(motion, dyad.length[1], MOVING, complex(turn))
        sizes = [float(np.prod(high - low)) for low, high in (_body(dyad), _ground(dyad))]
        main = MOVING if sizes[0] <= sizes[1] else GROUND
        return cls(replace(required, driver=dyad, driven=dyad), is_driver, replace(by_z, main=main))

    @property
    def tiles(self) -> Tiles:
        """Those that a cover begins with; TooMany where nothing bounds the places of pivots."""
        dyad, charts = self.required.driver, self.charts
        body, ground = _body(dyad), _ground(dyad)
        if not np.isfinite([*body, *ground]).all():
            raise TooMany("the plane takes too many squares to be covered")
        if charts.main == MOVING:
            ground = _about(charts, ground)
        of_z, of_c = (
            Tiles.rectangle(charts, kind, *corners, SQUARES)
            for kind, corners in ((MOVING, body), (GROUND, ground))
        )
        return Tiles.joined(of_z, of_c, charts.about_poles)


_Corners = tuple[FloatArray, FloatArray]


def _body(dyad: Dyad) -> _Corners:
    """Where the moving pivot can be, seen from the body."""
    box, reach = dyad.on_body, dyad.arm[1]
    low, high = np.transpose([box.x, box.y])
    return np.maximum(low, -reach), np.minimum(high, reach)


def _ground(dyad: Dyad) -> _Corners:
    """Where the ground pivot can be."""
    box, reach = dyad.ground, dyad.arm[1] + dyad.length[1]
    low, high = np.transpose([box.x, box.y])
    return np.maximum(low, -reach), np.minimum(high, reach)


def _about(charts: Charts, ground: _Corners) -> _Corners:
    """The part of a rectangle of ground pivots from which a moving one can be near its poles."""
    (low, high), (of_z, _), reach = ground, charts.poles, charts.longest + charts.radius
    if not len(of_z):
        return high, low
    places = np.array([of_z.real, of_z.imag])
    return np.maximum(low, places.min(axis=1) - reach), np.minimum(high, places.max(axis=1) + reach)


@dataclass(frozen=True, slots=True)
class Sites:
    """Tiles that may hold a dyad of a side, with its pivots; arrays by tile."""

    tiles: Tiles
    z: Span  # moving pivot
    c: Span  # ground pivot
    known: BoolArray  # whether one determines the other closely
    sense: IntArray  # in which a driver meets the poses; 0 where that is open

    @classmethod
    def of(cls, side: OneSide, tiles: Tiles) -> tuple[Sites, IntArray]:
        """Those of some tiles that may hold any, and which of these each is."""
        z, c, known = tiles.spans
        required = side.required
        keep = tiles.counted(z, c) & possible_arms(required, z)
        keep &= possible_radii(side.charts.motion.inverse(), c, required.driver.length)
        keep &= known | same_lengths(required.curve, z, c)
        rows = np.flatnonzero(keep)
        z, c = z[rows], c[rows]
        roles = roles_of(required, z, c)
        some = np.flatnonzero(roles.driver if side.is_driver else roles.driven)
        rows = rows[some]
        return cls(tiles[rows], z[some], c[some], known[rows], roles.sense[some]), rows

    def __len__(self) -> int:
        return len(self.tiles)

    def __getitem__(self, index: IntArray | BoolArray) -> Sites:
        every = self.tiles[index], self.z[index], self.c[index], self.known[index], self.sense[index]
        return Sites(*every)

    @classmethod
    def joined(cls, *parts: Sites) -> Sites:
        """Several as one."""
        return cls(
            Tiles.joined(*(part.tiles for part in parts)),
            Span.joined(*(part.z for part in parts)),
            Span.joined(*(part.c for part in parts)),
            np.concatenate([part.known for part in parts]),
            np.concatenate([part.sense for part in parts]),
        )

    @property
    def lengths(self) -> FloatArray:
        """Extent of z or c along each coordinate, shape (2, n)."""
        lengths: FloatArray = np.maximum(np.abs(self.z.steps), np.abs(self.c.steps))
        return lengths

    @property
    def halves(self) -> Tiles:
        """Halves of tiles across their longer side."""
        return self.tiles.halves(np.argmax(self.lengths, axis=0))

    @property
    def resolved(self) -> BoolArray:
        """Which tiles are small enough to begin with."""
        z, c = (np.abs(span.steps).max(axis=0) for span in (self.z, self.c))
        lengths, length = np.maximum(z, c), lengths_of(self.z, self.c).high
        short = (lengths <= COARSE * (0.3 + length)) & (z <= COARSE * (0.3 + np.abs(self.z.middle)))
        close = np.maximum(self.z.rest, self.c.rest) <= 0.3 * (lengths + 0.02)
        done: BoolArray = (self.known & short & close) | (self.tiles.half.max(axis=0) < TINY)
        return done


def is_empty(side: OneSide, most: int = MOST_TILES) -> bool | None:
    """Whether no dyad meets the requirements on a side; None where that is open at the end of the budget.

    TooMany where nothing bounds the places of its pivots; `StopRequested` on request.
    """
    active, count = side.tiles, 0
    while len(active):
        raise_if_stopped()
        count += len(active)
        if count > most:
            return None
        left, _ = Sites.of(side, active)
        middles, _ = Sites.of(side, left.tiles.middles)
        if middles.known.any():
            return False
        active = left.halves
    return True


@dataclass(slots=True)
class Tiling:
    """All tiles of a side that a proof works with: begun by a cover, halved as pairs need it."""

    side: OneSide
    sites: Sites
    _children: IntArray = field(init=False)

    def __post_init__(self) -> None:
        self._children = np.full((len(self.sites), 2), OPEN)

    @classmethod
    def covering(cls, side: OneSide) -> Tiling:
        """Tiles that hold all dyads that may meet the requirements; few enough for all pairs of them.

        TooMany where nothing bounds the places of its pivots; `StopRequested` on request.
        """
        done, _ = Sites.of(side, side.tiles)
        while not done.resolved.all() and len(done) < ENOUGH:
            raise_if_stopped()
            ready = done.resolved
            done = Sites.joined(done[ready], Sites.of(side, done[~ready].halves)[0])
        return cls(side, done)

    def __len__(self) -> int:
        return len(self.sites)

    @property
    def sizes(self) -> FloatArray:
        """Greatest distance of the pivots of each tile from its middle."""
        return np.maximum(self.sites.z.reach, self.sites.c.reach)

    def halve(self, which: IntArray) -> IntArray:
        """Numbers of the halves of tiles, shape (n, 2); negative for a half without a possible dyad."""
        new = np.unique(which[self._children[which, 0] == OPEN])
        if len(new):
            made, rows = Sites.of(self.side, self.sites[new].halves)
            numbers = np.full(2 * len(new), NOTHING)
            numbers[rows] = len(self.sites) + np.arange(len(made))
            self._children[new] = numbers.reshape(2, -1).T
            self.sites = Sites.joined(self.sites, made)
            self._children = np.concatenate([self._children, np.full((len(made), 2), OPEN)])
        halves: IntArray = self._children[which]
        return halves

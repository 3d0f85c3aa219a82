"""Regions: all linkages above half the best transmission angle, as pairs of small pieces that are joined.

Two linkages are in one region where a chain of pairs of pieces joins them, each near the next and all
of them able to hold a linkage that transmits enough.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from grashof.analysis import solve_position
from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.programme.start import Round
from grashof.synth.programme.whole_screening import fully_screened
from grashof.synth.proof.claims.bounds import Bounds
from grashof.synth.proof.curve.required import POSES, Required, with_forms
from grashof.synth.proof.curve.table import Table
from grashof.synth.proof.poses.branch_and_bound import Search
from grashof.synth.proof.poses.lookout import screened_pairs
from grashof.synth.proof.poses.pairs import Pairs
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.quantities.screening import Screened
from grashof.synth.starts.selection import feasible_starts, scores, starts_of
from grashof.synth.theory.distinct import best_first

SHARE = 0.5  # of the best transmission angle: less is not listed by regions
SIZE = 0.02  # sizes: pieces are halved down to this length
FEWEST, SMALLEST = 2000, 1e-3  # pairs below which pieces are halved further, and their least length
MOST_PAIRS = 100_000  # bounded for it
AT_ONCE = 256  # pieces compared with all others
SLACK = 1.2  # times their lengths: pieces whose middles are nearer are neighbours
NEAR = 4.0  # times the length of pieces: designs farther from all linkages of a region are of none
MOST_REGIONS = 20  # whose best linkages are begun from
CLOSER = 0.65  # share of the distance at which enough linkages are found: so the list has the better ones
SPREAD = 0.6  # of the best transmission angle: linkages above it are spread over


@dataclass(frozen=True, slots=True)
class Loci:
    """Where the joints of a four-bar can be: pieces of the curves of dyads, in the problem's unit."""

    moving: FloatArray  # (n, 2, 2): ends of each piece, of the moving pivot at the first pose
    ground: FloatArray  # (n, 2, 2): the same of the ground pivot that belongs to it
    # (n,), rad: of the best linkage that was seen with a dyad of the piece, as driver or driven
    transmission: FloatArray


@dataclass(frozen=True, slots=True)
class Atlas:
    """Linkages in the middle of pairs of pieces, in regions."""

    linkages: Screened  # that meet all requirements that are screened, in the frame of the search
    region: IntArray  # (n,): of each, numbered from 1 in the order of their best
    size: float  # sizes: half the length of the longest piece
    loci: Loci

    @property
    def count(self) -> int:
        """Number of regions."""
        return int(self.region.max(initial=0))

    def regions_of(self, scaled: ScaledProblem, designs: Sequence[Candidate]) -> list[int]:
        """Region of each design: that of the nearest linkage; 0 where none is near."""
        if not len(self.linkages):
            return [0] * len(designs)
        places, found = _coordinates(self.linkages.points[:, :4]), []
        for place in _coordinates(np.array([_first_points(scaled, each) for each in designs]).reshape(-1, 4)):
            apart = np.abs(places - place).max(axis=1)
            nearest = int(np.argmin(apart))
            found.append(int(self.region[nearest]) if apart[nearest] <= NEAR * self.size else 0)
        return found


def atlas_of(scaled: ScaledProblem, bounds: Bounds) -> Atlas | None:
    """All four-bars of four poses above half the best that bounds know; None where they know none.

    `StopRequested` on request.
    """
    if not bounds.closed or not bounds.lower or len(scaled.targets) != POSES or scaled.motion is None:
        return None
    about = with_forms(scaled) if bounds.left_out else scaled
    required = Required.of(about)
    required = replace(required, floor=max(required.floor, SHARE * bounds.lower))
    table = Table.covering(required)
    pairs = _small_pairs(required, table)
    linkages = screened_pairs(scaled, required, table, pairs)
    feasible = np.flatnonzero(linkages.feasible)
    labels, linkages = _joined(table, pairs)[feasible], linkages[feasible]
    names, label = np.unique(labels, return_inverse=True)
    best = np.zeros(len(names))
    np.maximum.at(best, label, linkages.transmission)
    number = np.empty(len(names), dtype=np.int64)
    number[np.argsort(-best, kind="stable")] = 1 + np.arange(len(names))
    sizes = _lengths(table, np.unique(np.concatenate([pairs.driver, pairs.driven])))
    loci = _loci(scaled, required, table, pairs[feasible], linkages.transmission)
    return Atlas(linkages, number[label], float(sizes.max(initial=SMALLEST)), loci)


def _loci(
    scaled: ScaledProblem, required: Required, table: Table, pairs: Pairs, transmission: FloatArray
) -> Loci:
    """The pieces of pairs, each with the best of its linkages."""
    used, piece = np.unique(np.concatenate([pairs.driver, pairs.driven]), return_inverse=True)
    best = np.zeros(len(used))
    np.maximum.at(best, piece, np.tile(transmission, 2))
    tubes, centres = table.pieces.tubes[used], table.pieces.centres[used]

    def ends(middle: ComplexArray, along: ComplexArray) -> FloatArray:
        return scaled.frame.outward(np.stack([middle - along, middle + along], axis=1) + required.origin)

    return Loci(ends(tubes.middle, tubes.along), ends(centres.middle, centres.along), best)


def _small_pairs(required: Required, table: Table) -> Pairs:
    """Pairs of pieces that may hold linkages above the floor, halved until they are short."""
    search, size = Search(required, 0.0, 10 * MOST_PAIRS), SIZE
    pairs, done = search.first(table), list[Pairs]()
    while pairs is not None and len(pairs):
        one, other = _lengths(table, pairs.driver) > size, _lengths(table, pairs.driven) > size
        more = one | other
        done.append(pairs[~more])
        pairs, one, other = pairs[more], one[more], other[more]
        if search.pairs + int(np.where(one & other, 4, 2).sum()) > MOST_PAIRS:
            done.append(pairs)
            break
        pairs = search.halved(table, pairs, one, other)
        if pairs is not None and not len(pairs) and 0 < sum(map(len, done)) < FEWEST and size > SMALLEST:
            pairs, size, done = Pairs.joined(done), size / 2, []
    return Pairs.joined(done)


def _lengths(table: Table, pieces: IntArray) -> FloatArray:
    """Half the lengths of pieces, or of the ways of their centres where these are longer, sizes."""
    lengths: FloatArray = np.maximum(
        table.pieces.tubes.half[pieces], np.abs(table.pieces.centres.along[pieces])
    )
    return lengths


def _joined(table: Table, pairs: Pairs) -> IntArray:
    """A number for each pair, shared by all pairs that chains of neighbours join."""
    used, numbers = np.unique(np.concatenate([pairs.driver, pairs.driven]), return_inverse=True)
    count = len(pairs)
    if not count:
        return np.zeros(0, dtype=np.int64)
    first, second = numbers[:count].astype(np.int64), numbers[count:].astype(np.int64)
    start, neighbours = _neighbours(table, used)
    codes = first * len(used) + second
    order = np.argsort(codes)
    ends = []
    for moved, kept, swapped in ((first, second, False), (second, first, True)):
        many = np.diff(start)[moved]
        source = np.repeat(np.arange(count), many)
        place = np.arange(len(source)) - np.repeat(np.cumsum(many) - many, many)
        other = neighbours[start[moved][source] + place]
        wanted = kept[source] * len(used) + other if swapped else other * len(used) + kept[source]
        found = np.minimum(np.searchsorted(codes[order], wanted), count - 1)
        there = codes[order][found] == wanted
        ends.append((source[there], order[found[there]]))
    rows, columns = (np.concatenate(side) for side in zip(*ends, strict=True))
    return _components(count, rows, columns)


def _components(count: int, rows: IntArray, columns: IntArray) -> IntArray:
    """The least number in the component of each node of a graph, by its edges.

    Labels spread along edges, and each jumps to the label of its label, until nothing changes.
    """
    labels = np.arange(count)
    while True:
        before = labels.copy()
        np.minimum.at(labels, rows, before[columns])
        np.minimum.at(labels, columns, labels[rows])
        labels = labels[labels]
        if np.array_equal(labels, before):
            return labels


def _neighbours(table: Table, used: IntArray) -> tuple[IntArray, IntArray]:
    """Pieces near each of some pieces: where theirs begin, and their numbers among these."""
    tubes, centres = table.pieces.tubes[used], table.pieces.centres[used]
    reach, way = tubes.half + tubes.side, np.abs(centres.along) + centres.rest
    numbers, many = [], []
    for k in range(0, len(used), AT_ONCE):
        rows = np.arange(k, min(k + AT_ONCE, len(used)))[:, None]
        near = np.abs(tubes.middle[rows] - tubes.middle) <= SLACK * (reach[rows] + reach)
        near &= np.abs(centres.middle[rows] - centres.middle) <= SLACK * (way[rows] + way)
        near &= rows != np.arange(len(used))
        numbers.append(np.nonzero(near)[1])
        many.append(near.sum(axis=1))
    start = np.concatenate([[0], np.cumsum(np.concatenate(many))])
    return start, np.concatenate(numbers)


def _coordinates(points: ComplexArray) -> FloatArray:
    """Points, shape (n, k), as real coordinates, shape (n, 2 k)."""
    return np.concatenate([points.real, points.imag], axis=1)


def _first_points(scaled: ScaledProblem, design: Candidate) -> list[complex]:
    """O2, O4 and A, B at the first target in the frame of the search."""
    linkage, verdict = design.linkage, design.verdict
    state = solve_position(linkage, verdict.theta2[0], verdict.assembly[0])
    return [complex(scaled.frame.inward(np.asarray(x))) for x in (linkage.o2, linkage.o4, state.a, state.b)]


def round_of_regions(scaled: ScaledProblem, atlas: Atlas, enough: int) -> Round:
    """Starts from the best linkage of each region, then as from any feasible linkages."""
    linkages = fully_screened(scaled, atlas.linkages)
    rows = np.flatnonzero(linkages.feasible)
    order = rows[best_first(scores(scaled, linkages[rows]))]
    _, first = np.unique(atlas.region[order], return_index=True)
    firsts = order[np.sort(first)][:MOST_REGIONS]
    good = rows[linkages.transmission[rows] >= SPREAD * linkages.transmission[rows].max(initial=0.0)]
    starts = starts_of(scaled, linkages, firsts)
    starts += feasible_starts(scaled, linkages[good], enough, peaks=0, closer=CLOSER)
    return Round(starts, {"feasible finds": len(rows)})

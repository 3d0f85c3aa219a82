"""Slider-cranks through four whole poses: bounds of the best design, over pieces of the crank's curve.

Only one point of the body can slide on a line through all poses, so that B and the slide are known; the
crank is any dyad of the circle-point curve. One parameter remains.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from time import perf_counter

import numpy as np

from grashof.problems.values.arrays import ComplexArray, FloatArray, IntArray
from grashof.synth.designs.candidate import Candidate
from grashof.synth.designs.judging import judged
from grashof.synth.proof.claims.bounds import STOPPED, TOO_SMALL, Bounds, Proving, logged
from grashof.synth.proof.claims.proof import quantity_of
from grashof.synth.proof.curve.dyads import roles_of
from grashof.synth.proof.curve.required import POSES, left_out, not_bounded, unusable, with_forms
from grashof.synth.proof.curve.sliding import Slide
from grashof.synth.proof.curve.table import Table, TooMany
from grashof.synth.proof.forms.forms import Span
from grashof.synth.proof.poses.cranks import Cranks
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Displacements, Dyads, centre_points, polish
from grashof.synth.theory.stopping import StopRequested, stop_requested

MOST_LEVELS = 60  # pieces are as small as rounding then
MOST, JUDGED = 4000, 4  # pieces examined at each level, and the number of them judged, twice
MOST_PIECES = 50_000  # bounded; practical tasks take some hundred
# Fields of the requirements that have forms.
FORMS = (
    "transmission_min_deg",
    "link_length", "r2", "r3", "link_ratio_max", "coupler_arms",
    "offset", "slide_angle_deg",
    "o2", "a", "b", "a_on_body", "b_on_body",
    "driver_sense", "driver_rotation_deg", "theta2_start_deg",
)  # fmt: skip


def bounds_of_slider_cranks(
    scaled: ScaledProblem, proving: Proving, at_least: float | None = None
) -> Bounds | None:
    """Bounds of the best slider-crank through four whole poses; None for other problems.

    With `at_least`, deg, it only decides whether a design has that much, and ends with the first one.
    """
    if not _suits(scaled):
        return None
    since = perf_counter()
    moving = _with_motion(scaled)
    if why := not_bounded(moving) or unusable(moving):
        return Bounds(why=why, refused=True)
    slide = Slide.of(Cranks.curve_of(moving))
    if slide is None:
        return Bounds(why="the poses have a line of points that can slide, or nearly so", refused=True)
    without = left_out(scaled, FORMS)
    about = _with_motion(with_forms(scaled, FORMS)) if without else moving
    cranks = Cranks.of(about, slide, at_least)
    if not cranks.may_slide:
        why = _outside(about, slide)
        made = Bounds(upper=cranks.required.floor, closed=True, left_out=without, why=why)
        return logged(replace(made, seconds=perf_counter() - since))
    search = _Search(about, cranks, float(np.radians(proving.gap)), min(proving.most_pairs, MOST_PIECES))
    try:
        search.run(content=at_least is not None)
        why = "" if search.done or (search.best and at_least is not None) else search.why
    except TooMany as ended:
        why = str(ended)
    except StopRequested:
        why = STOPPED
    made = Bounds(
        lower=search.lower,
        upper=search.upper,
        closed=search.done,
        found=search.best,
        pieces=(search.begun, 1),
        pairs=search.bounded,
        levels=search.levels,
        seconds=perf_counter() - since,
        left_out=without,
        why=why,
    )
    return logged(made)


def _suits(scaled: ScaledProblem) -> bool:
    """Whether these are slider-cranks through four whole poses, met exactly, at any time."""
    task = scaled.problem.task
    exact = scaled.exact and task.is_whole and len(task) == POSES
    free = not task.is_timed and not (task.closed and task.returns)
    return scaled.kind.dyad.bars == 1 and exact and free


def _with_motion(scaled: ScaledProblem) -> ScaledProblem:
    """The same with displacements of the body."""
    return replace(scaled, motion=Displacements.from_poses(scaled.targets, scaled.turns))


def _outside(scaled: ScaledProblem, slide: Slide) -> str:
    """The place that B and the slide would need, in words."""
    x, y = scaled.frame.outward(np.array(slide.point + complex(scaled.targets[0])))
    angle = np.degrees(np.angle(slide.along)) % 180
    place = f"({x:.6g}, {y:.6g}) at the first, on a line at {angle:.6g} deg"
    return f"one point alone slides through the poses, {place}, and the limits of B or its slide exclude it"


@dataclass(slots=True)
class _Search:
    """A branch and bound over pieces of the curve."""

    scaled: ScaledProblem  # with the requirements that the proof is about, and displacements of the body
    cranks: Cranks
    gap: float  # rad
    most: int  # budget of pieces
    lower: float = 0.0
    best: Candidate | None = None
    begun: int = 0
    bounded: int = 0
    levels: int = 0
    why: str = ""
    _left: FloatArray | None = field(default=None)  # bounds of the pieces that are left

    @property
    def threshold(self) -> float:
        """Designs that transmit less do not count, rad."""
        return max(self.lower + self.gap if self.best else 0.0, self.cranks.required.floor)

    @property
    def done(self) -> bool:
        """Whether no design transmits more than `threshold`."""
        return self._left is not None and not len(self._left)

    @property
    def upper(self) -> float:
        """No design transmits more, rad."""
        if self._left is None:
            return float(np.pi / 2)
        return max(self.threshold, float(self._left.max(initial=0.0)))

    def run(self, *, content: bool = False) -> None:
        """Bound all pieces, look for designs in those that are left, halve these, until none is left."""
        table = Table.covering(self.cranks.required)
        pieces = np.flatnonzero(table.pieces.driver)
        self.begun = len(pieces)
        while True:
            if self.bounded + len(pieces) > self.most or stop_requested():
                over = self.bounded + len(pieces) > self.most
                self.why = f"the budget of {self.most} pieces ended" if over else STOPPED
                return
            self.bounded += len(pieces)
            rows, bound = self._rows_left(table, pieces)
            pieces, self._left = pieces[rows], bound
            self._look(table, pieces[np.argsort(-bound, kind="stable")[:MOST]])
            kept = bound > self.threshold
            pieces, self._left = pieces[kept], bound[kept]
            if not len(pieces) or (content and self.best):
                return
            if self.levels >= MOST_LEVELS:
                self.why = TOO_SMALL
                return
            halves = table.halve(pieces).ravel()
            halves = halves[halves >= 0]
            pieces, self.levels = halves[table.pieces.driver[halves]], self.levels + 1

    def _rows_left(self, table: Table, pieces: IntArray) -> tuple[IntArray, FloatArray]:
        some = table.pieces[pieces]
        least = np.full(len(pieces), self.threshold)
        return self.cranks.rows_left(some.tubes.span, some.centres.span, some.sense, least)

    def _look(self, table: Table, pieces: IntArray) -> None:
        """Take the best design in the middle of pieces that the judge accepts, where it is better."""
        curve, least = self.cranks.required.curve, max(self.lower, self.cranks.required.floor)
        motion = Displacements(curve.rotation, curve.shift)
        z = curve.onto(table.pieces.tubes.middle[pieces])
        c = centre_points(motion, z)
        known = np.isfinite(z) & np.isfinite(c)
        if not known.any():
            return
        dyads = polish(motion, Dyads(z[known], c[known]), steps=2)
        a, o2 = _alone(dyads.moving), _alone(dyads.ground)
        sense = roles_of(self.cranks.required, a, o2).sense
        rows, bound = self.cranks.rows_left(a, o2, sense, np.full(len(sense), least))
        order = rows[np.argsort(-bound, kind="stable")]
        # Between limits of no width the best are at the edge of the slack, which the judge does not grant.
        spread = order[np.linspace(0, len(order) - 1, JUDGED).astype(int)] if len(order) else order
        for row in dict.fromkeys([*order[:JUDGED].tolist(), *spread.tolist()]):
            if self._taken(complex(dyads.moving[row]), complex(dyads.ground[row])):
                return

    def _taken(self, a: complex, o2: complex) -> bool:
        """Whether the judge accepts the linkage of a crank, and it is the best so far."""
        slide, origin = self.cranks.slide, self.cranks.required.origin
        rod = slide.point - a
        for along in (slide.along, -slide.along):
            o4 = slide.point + abs(rod) * along
            points = np.array([o2, o4, a, slide.point, 0.0]) + origin
            assembly = 1 if (along.conjugate() * rod).real > 0 else -1
            made = judged(self.scaled, points, assembly, 0.0, start=0, iterations=0)
            if made is None or not made.verdict.ok:
                continue
            transmitted = float(made.values[quantity_of(self.scaled.problem).key])
            if transmitted <= max(self.lower, self.cranks.required.floor):
                return False
            self.lower, self.best = transmitted, made
            return True
        return False


def _alone(points: ComplexArray) -> Span:
    """Points as forms that depend on nothing."""
    return Span(points, np.zeros((1, len(points)), dtype=np.complex128), np.zeros(len(points)))

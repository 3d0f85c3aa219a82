"""Pieces of the curve that a proof works with: begun by a cover, halved as pairs need it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, IntArray
from grashof.synth.proof.curve.centres import Centres, centres_of
from grashof.synth.proof.curve.dyads import lengths_of, possible_arms, roles_of
from grashof.synth.proof.curve.pieces import SLENDER, WIDER, Tubes, contracted
from grashof.synth.proof.curve.required import Required
from grashof.synth.proof.forms.forms import Form, Span
from grashof.synth.theory.stopping import raise_if_stopped

SQUARES = 32  # along each side of the disc that is covered
COARSE = 0.5  # length of first pieces, as a share of the local scale
TINY = 4e-3  # sizes: pieces of at most this size are not halved on their own
MOST_RECTANGLES = 100_000  # of a cover
_Steps = TypeVar("_Steps", FloatArray, ComplexArray)
ROOT = -1  # parent of the rectangles that a cover begins with
OPEN, NOTHING = -1, -2  # children that are not made yet; that hold no dyad


@dataclass(slots=True)
class Trail:
    """Rectangles that a proof examined, by number, and the pairs that it halved: enough for a certificate."""

    rectangles: list[Tubes] = field(default_factory=list)
    # Numbers of the rectangles that these are halves of
    parents: list[IntArray] = field(default_factory=list)
    # Number of the rectangle that each piece of the table is in
    pieces: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    first: int = 0  # number of these pieces that a proof begins with
    # Driver and driven pieces of pairs, level by level
    halved: list[tuple[IntArray, IntArray]] = field(default_factory=list)

    def look(self, rectangles: Tubes, parents: IntArray) -> IntArray:
        """Note rectangles; their numbers."""
        begin = sum(map(len, self.parents))
        self.rectangles.append(rectangles)
        self.parents.append(parents)
        return np.arange(begin, begin + len(parents))


class TooMany(Exception):  # noqa: N818  (no error: the proof stays open)
    """A proof takes more pieces than it may, or than it can distinguish; states which."""


@dataclass(frozen=True, slots=True)
class Pieces:
    """Pieces with their centres and the data that pairs need; arrays of shape (n,) or (n, 4)."""

    tubes: Tubes
    centres: Centres
    driver: BoolArray
    driven: BoolArray
    sense: IntArray

    def __len__(self) -> int:
        return len(self.tubes)

    @classmethod
    def of(cls, required: Required, tubes: Tubes) -> tuple[Pieces, IntArray]:
        """The pieces in rectangles, and the rectangle of each."""
        tubes, filled = contracted(required.curve, tubes)
        rows = np.flatnonzero(filled)
        tubes = tubes[rows]
        near = possible_arms(required, tubes.span)
        rows, tubes = rows[near], tubes[near]
        centres = centres_of(required.curve, tubes, required.longest)
        roles = roles_of(required, tubes.span, centres.span)
        some = np.flatnonzero(roles.driver | roles.driven)
        kept = cls(tubes[some], centres[some], roles.driver[some], roles.driven[some], roles.sense[some])
        return kept, rows[some]

    def __getitem__(self, index: IntArray | BoolArray) -> Pieces:
        return Pieces(
            self.tubes[index], self.centres[index], self.driver[index], self.driven[index], self.sense[index]
        )

    @classmethod
    def joined(cls, *parts: Pieces) -> Pieces:
        """Several as one."""
        return cls(
            Tubes.joined(*(part.tubes for part in parts)),
            Centres.joined(*(part.centres for part in parts)),
            *(
                np.concatenate([getattr(part, name) for part in parts])
                for name in ("driver", "driven", "sense")
            ),
        )

    @property
    def resolved(self) -> BoolArray:
        """Which pieces are short enough to begin with."""
        tubes, centres = self.tubes, self.centres
        moved = np.abs(centres.along)
        short = tubes.half + moved <= COARSE * (
            0.3 + np.minimum(lengths_of(tubes.span, centres.span).high, np.abs(tubes.middle))
        )
        slender = tubes.side <= SLENDER * tubes.half
        known = centres.rest <= 0.3 * (moved + 0.02)
        done: BoolArray = (short & slender & known) | (tubes.half + tubes.side < TINY)
        return done


def squares(required: Required) -> Tubes:
    """The squares that a cover begins with: within reach of the arms."""
    reach = required.driver.arm[1]
    step = 2 * reach / SQUARES
    even = -reach + step * (np.arange(SQUARES) + 0.5)
    middle = (even[:, None] + 1j * even).ravel()
    size = np.full(len(middle), step / 2 * (1 + WIDER))  # no gaps by rounding
    return Tubes.rectangles(middle, np.ones_like(middle), size, size)


@dataclass(slots=True)
class Table:
    """All pieces of a proof."""

    required: Required
    pieces: Pieces
    rectangles: int = 0  # number of rectangles examined
    trail: Trail | None = None  # where these are noted
    _children: IntArray = field(init=False)

    def __post_init__(self) -> None:
        self._children = np.full((len(self.pieces), 2), OPEN)

    @classmethod
    def covering(cls, required: Required, trail: Trail | None = None) -> Table:
        """Pieces that hold all dyads that may meet the requirements on one.

        TooMany where they take more rectangles than a cover may have; `StopRequested` on request.
        """
        active = squares(required)
        parents = np.full(len(active), ROOT)
        noted = Trail() if trail is None else trail
        done: list[Pieces] = []
        places: list[IntArray] = []
        count = 0
        while len(active):
            raise_if_stopped()
            count += len(active)
            if count > MOST_RECTANGLES:
                raise TooMany("the curve takes too many pieces to be covered")
            found, rows = Pieces.of(required, active)
            numbers, ready = noted.look(active, parents)[rows], found.resolved
            done.append(found[ready])
            places.append(numbers[ready])
            active, parents = found.tubes[~ready].halves, np.tile(numbers[~ready], 2)
        noted.pieces = np.concatenate(places)
        noted.first = len(noted.pieces)
        return cls(required, Pieces.joined(*done), count, trail)

    def __len__(self) -> int:
        return len(self.pieces)

    def halve(self, which: IntArray) -> IntArray:
        """Numbers of the halves of pieces, shape (n, 2); negative for a half without a possible dyad."""
        new = np.unique(which[self._children[which, 0] == OPEN])
        if len(new):
            rectangles = self.pieces.tubes[new].halves
            made, rows = Pieces.of(self.required, rectangles)
            if self.trail is not None:
                looked_at = self.trail.look(rectangles, np.tile(self.trail.pieces[new], 2))
                self.trail.pieces = np.concatenate([self.trail.pieces, looked_at[rows]])
            numbers = np.full(2 * len(new), NOTHING)
            numbers[rows] = len(self.pieces) + np.arange(len(made))
            self._children[new] = numbers.reshape(2, -1).T
            self.pieces = Pieces.joined(self.pieces, made)
            self._children = np.concatenate([self._children, np.full((len(made), 2), OPEN)])
            self.rectangles += 2 * len(new)
        halves: IntArray = self._children[which]
        return halves


@dataclass(frozen=True, slots=True)
class Side:
    """Dyads of some pieces as drivers, whose symbols come first, or as driven ones."""

    moving: Span  # z, of the symbols of this side alone
    ground: Span  # c, likewise
    is_driver: bool

    @classmethod
    def of(cls, pieces: Pieces, index: IntArray, *, is_driver: bool) -> Side:
        """Some pieces, in any order."""
        return cls(pieces.tubes[index].span, pieces.centres[index].span, is_driver)

    def __getitem__(self, index: IntArray | BoolArray) -> Side:
        return Side(self.moving[index], self.ground[index], self.is_driver)

    def span(self, own: Span) -> Span:
        """A complex form of the symbols of this side as one of both."""
        return Span(own.middle, self._of_both(own.steps), own.rest)

    def _of_both(self, own: _Steps) -> _Steps:
        nothing = np.zeros_like(own)
        return np.concatenate((own, nothing) if self.is_driver else (nothing, own))

    @property
    def z(self) -> Span:
        """The moving pivot at the first pose."""
        return self.span(self.moving)

    @property
    def c(self) -> Span:
        """The ground pivot."""
        return self.span(self.ground)

    def seen_from_body(self, rotation: complex, shift: complex) -> Span:
        """From the ground pivot, as the body sees it at a pose, to the moving pivot."""
        back = complex(np.conj(rotation))
        return self.span(self.moving - self.ground.placed(back, -back * shift))

    @property
    def length(self) -> Form:
        """The distance from the ground pivot to the moving one."""
        own = (self.moving - self.ground).norm
        return Form(own.centre, self._of_both(own.slopes), own.rest)

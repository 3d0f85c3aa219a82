"""All dyads through five poses within limits, each in a box that holds exactly one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter

import numpy as np

from grashof.problems import Problem
from grashof.problems.values.arrays import TURN, BoolArray, ComplexArray, FloatArray, IntArray
from grashof.problems.values.text import counted
from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.claims.proof import Claim, Proof, best_listed, quantity_of
from grashof.synth.proof.curve.pieces import WIDER, Tubes
from grashof.synth.proof.curve.required import Required, unusable
from grashof.synth.proof.curve.table import Pieces, squares
from grashof.synth.proof.forms.forms import Form, Span
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.five_poses import five_pose_dyads
from grashof.synth.theory.stopping import StopRequested, raise_if_stopped

FIVE = 5
STOPPED = "it was stopped"
MOST_RECTANGLES = 300_000
CLOSE = 0.9  # of the largest box that Krawczyk's test accepts, about
_NEWTON = 30  # steps from a remaining box to a root
_SMALL = 1e-3  # sizes: pieces as short as that are tried for a root of their own


@dataclass(frozen=True, slots=True)
class Certified:
    """Dyads that five poses have for certain, in the frame of a `Curve`."""

    moving: ComplexArray  # (n,), sizes
    ground: ComplexArray  # (n,), sizes
    # (n,), sizes: half the width of a box of both points, in all four coordinates, with this dyad alone
    box: FloatArray
    complete: bool = False  # whether all that may meet the limits of a dyad are among them
    within: int = 0  # number that may meet them
    rectangles: int = 0  # number of rectangles examined
    seconds: float = 0.0  # s
    why: str = ""  # why they are not all; else empty

    def __len__(self) -> int:
        return len(self.moving)

    @classmethod
    def nothing(cls) -> Certified:
        """No dyad."""
        nowhere = np.zeros(0, dtype=np.complex128)
        return cls(nowhere, nowhere, np.zeros(0))


def certified_poses(scaled: ScaledProblem) -> Certified | None:
    """All dyads of a problem of five whole poses, met exactly by a four-bar; None for other problems.

    The finder has to know each of them: else they are not all.
    """
    if scaled.motion is None or len(scaled.targets) != FIVE or scaled.problem.driver is not None:
        return None
    if why := unusable(scaled):
        return replace(Certified.nothing(), why=why)
    since = perf_counter()
    required = replace(Required.of(scaled), rotation=(0.0, TURN))
    shift = scaled.motion.apply(np.array([required.origin]))[0] - required.origin
    motion = Displacements(scaled.motion.rotation, shift)
    try:
        made = certified_dyads(required, motion)
    except StopRequested:
        return replace(Certified.nothing(), why=STOPPED)
    why = why_open(made, motion)
    return replace(made, complete=not why, seconds=perf_counter() - since, why=why)


def why_open(made: Certified, motion: Displacements) -> str:
    """Why the dyads may be incomplete, or unknown to the search; empty where they are all known."""
    if not made.complete:
        return "the curve takes too many pieces, as near a double dyad"
    known = five_pose_dyads(motion).moving
    unknown = [z for z, box in zip(made.moving, made.box, strict=True) if np.all(np.abs(known - z) > box)]
    return f"{counted(len(unknown), 'dyad')} came up that the search does not know" if unknown else ""


def certified_dyads(required: Required, motion: Displacements) -> Certified:
    """All dyads of five displacements that meet the limits of a dyad, and perhaps some that do not.

    The curve of `required` is that of the first four poses, and the displacements are seen from its origin. A
    cover of the curve is taken; a piece is dropped where the equation of the fifth pose has no zero on it,
    and settled where it lies in a box in which Krawczyk's test (*Computing* 4, 1969) proves that there is
    exactly one zero of all four equations. `StopRequested` on request.
    """
    known = _certified(motion, five_pose_dyads(motion))
    active, count = squares(required), 0
    last = complex(motion.rotation[-1]), complex(motion.shift[-1])
    while len(active):
        raise_if_stopped()
        count += len(active)
        if count > MOST_RECTANGLES:
            return _counted(required, known, complete=False, rectangles=count)
        pieces, _ = Pieces.of(required, active)
        pieces = pieces[_may_meet(pieces.tubes.span, pieces.centres.span, *last)]
        pieces = pieces[~_settled(known, pieces)]
        small = np.flatnonzero(pieces.tubes.half < _SMALL)
        if small.size:
            more = _certified(motion, _newton(motion, pieces, small[:1]))
            known = _joined(known, more)
            pieces = pieces[~_settled(known, pieces)]
        active = pieces.tubes.halves
    return _counted(required, known, complete=True, rectangles=count)


def _counted(required: Required, known: Certified, *, complete: bool, rectangles: int) -> Certified:
    """The same with the number that may meet the limits."""
    size = 1e-9 * (1.0 + np.abs(known.moving))
    points = Tubes.rectangles(known.moving, np.ones_like(known.moving), size, size)
    within = len(Pieces.of(required, points)[0])
    return replace(known, complete=complete, within=within, rectangles=rectangles)


def _may_meet(z: Span, c: Span, rotation: complex, shift: complex) -> BoolArray:
    """Where the distance from z to c may be the same at another pose as at the first."""
    facing = np.conj(shift) * rotation
    chord = z.placed(rotation - 1, shift)
    half = Form(
        abs(shift) ** 2 / 2 + (facing * z.middle).real,
        (facing * z.steps).real,
        abs(facing) * z.rest + WIDER * (1.0 + np.abs(facing * z.middle)),
    )
    miss = half - c.dot(chord)
    meets: BoolArray = (miss.inf <= 0) & (miss.sup >= 0)
    return meets


def _equations(motion: Displacements, z: ComplexArray, c: ComplexArray) -> tuple[FloatArray, FloatArray]:
    """The four equations, shape (n, 4), and their derivatives by z and c, shape (n, 4, 4)."""
    rotation, shift = motion.rotation[1:], motion.shift[1:]
    alpha, facing = rotation - 1, shift.conj() * rotation
    chord = alpha * z[:, None] + shift
    by_z = facing - c.conj()[:, None] * alpha
    miss = np.abs(shift) ** 2 / 2 + (facing * z[:, None]).real - (c.conj()[:, None] * chord).real
    slopes = np.stack([by_z.real, -by_z.imag, -chord.real, -chord.imag], axis=-1)
    return miss, slopes


def _certified(motion: Displacements, dyads: Dyads) -> Certified:
    """Those of some dyads that Krawczyk's test accepts, each once."""
    z, c = dyads.moving, dyads.ground
    miss, slopes = _equations(motion, z, c)
    inverse = np.linalg.pinv(slopes)
    unit = np.abs(np.eye(4) - inverse @ slopes).sum(axis=-1)
    size = np.abs(z) + np.abs(c) + np.abs(motion.shift).max()
    rounding = 64 * np.finfo(float).eps * (size**2)[:, None]
    off = (np.abs(inverse) @ (np.abs(miss) + rounding)[..., None])[..., 0]
    alpha = np.abs(motion.rotation[1:] - 1)
    bend = 4 * np.sqrt(2) * (np.abs(inverse) @ alpha)
    box = CLOSE * ((1 - unit) / bend).min(axis=-1)
    accepted = np.all(off + (unit + bend * box[:, None]) * box[:, None] < box[:, None], axis=-1) & (box > 0)
    kept: list[int] = []
    for k in np.flatnonzero(accepted).tolist():
        same = [i for i in kept if max(_apart(z[k] - z[i]), _apart(c[k] - c[i])) <= box[i]]
        if not same:
            kept.append(k)
    return Certified(z[kept], c[kept], box[kept])


def _apart(step: complex) -> float:
    return max(abs(step.real), abs(step.imag))


def _joined(known: Certified, more: Certified) -> Certified:
    new = [
        k
        for k in range(len(more))
        if not any(
            max(_apart(more.moving[k] - z), _apart(more.ground[k] - c)) <= box
            for z, c, box in zip(known.moving, known.ground, known.box, strict=True)
        )
    ]
    parts = ((known.moving, more.moving), (known.ground, more.ground), (known.box, more.box))
    moving, ground, box = (np.concatenate([old, added[new]]) for old, added in parts)
    return Certified(moving, ground, box)


def _settled(known: Certified, pieces: Pieces) -> BoolArray:
    """Which pieces lie in the box of a dyad that is known."""
    tubes, centres = pieces.tubes, pieces.centres
    settled = np.zeros(len(pieces), dtype=bool)
    for z, c, box in zip(known.moving, known.ground, known.box, strict=True):
        inside = np.ones(len(pieces), dtype=bool)
        for middle, along, rest in (
            (tubes.middle - z, tubes.along, tubes.stray),
            (centres.middle - c, centres.along, centres.rest),
        ):
            inside &= np.abs(middle.real) + np.abs(along.real) + rest < box
            inside &= np.abs(middle.imag) + np.abs(along.imag) + rest < box
        settled |= inside
    return settled


def _newton(motion: Displacements, pieces: Pieces, which: IntArray) -> Dyads:
    """Where Newton's method leads from the middle of pieces."""
    z, c = pieces.tubes.middle[which], pieces.centres.middle[which]
    for _ in range(_NEWTON):
        miss, slopes = _equations(motion, z, c)
        step = (np.linalg.pinv(slopes) @ miss[..., None])[..., 0]
        z, c = z - step[:, 0] - 1j * step[:, 1], c - step[:, 2] - 1j * step[:, 3]
    return Dyads(z, c)


def proof_of_all(problem: Problem, dyads: Certified, designs: Sequence[Candidate], *, whole: bool) -> Proof:
    """The proof of listed designs by certified dyads of five poses, where the search was exhaustive."""
    best = best_listed(problem, designs)
    proof = Proof(
        claim=Claim.REFUSED,
        quantity=quantity_of(problem).column,
        lower=best,
        pieces=(dyads.within, dyads.within),
        seconds=round(dyads.seconds, 4),
        why=dyads.why or ("" if whole else "the search was not exhaustive"),
    )
    if proof.why:
        return proof
    claim = Claim.NONE if best is None else Claim.BEST
    return replace(proof, claim=claim, complete=True, upper=best)

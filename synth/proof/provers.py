"""The available proofs, each with the problems that it covers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from grashof.synth.designs.candidate import Candidate
from grashof.synth.proof.claims.bounds import Bounds, Proving
from grashof.synth.proof.claims.proof import quantity_of
from grashof.synth.quantities.scaled_problem import ScaledProblem

if TYPE_CHECKING:
    from grashof.synth.proof.poses.five_poses import Certified


def bounds_of(scaled: ScaledProblem, proving: Proving, at_least: float | None = None) -> Bounds | None:
    """Bounds of the best design; None where no proof covers the problem, or it would take minutes.

    With `at_least`, deg, it only decides whether a design has that much.
    """
    found = (prover(scaled, proving, at_least) for prover in _provers(scaled))
    return next((bounds for bounds in found if bounds is not None), None)


def _provers(
    scaled: ScaledProblem,
) -> Iterator[Callable[[ScaledProblem, Proving, float | None], Bounds | None]]:
    """The provers of a kind of task; those of other kinds are not loaded."""
    if not scaled.one_loop:
        return
    if scaled.problem.task.at_limits:
        from grashof.synth.proof.strokes.cover import bounds_of_stroke

        yield bounds_of_stroke
    elif scaled.exact and scaled.problem.task.is_whole:
        from grashof.synth.proof.poses.four_poses import bounds_of_four

        yield bounds_of_four
        from grashof.synth.proof.poses.three_poses import bounds_of_three

        yield bounds_of_three
        from grashof.synth.proof.poses.slider_cranks import bounds_of_slider_cranks

        yield bounds_of_slider_cranks


def bounds_before(scaled: ScaledProblem, proving: Proving) -> Bounds | None:
    """Bounds proven before a search, in a second; None where there are none, or they would take minutes."""
    return bounds_of(scaled, replace(proving, minutes=False))


def bounds_after(
    scaled: ScaledProblem, proving: Proving, before: Bounds | None, designs: Sequence[Candidate]
) -> Bounds | None:
    """Bounds proven at the end of a search: where minutes are given, bounds above its best design.

    `before` are the bounds proven before it, and `designs` its designs.
    """
    if not scaled.one_loop:
        return None
    best = max((one.values[quantity_of(scaled.problem).key] for one in designs), default=0.0)
    if scaled.problem.task.has_output.all():
        from grashof.synth.proof.functions.few_pairs import bounds_of_pairs

        return bounds_of_pairs(scaled, proving, float(best))
    if not proving.minutes or (before is not None and before.closed) or scaled.motion is None:
        return before
    from grashof.synth.proof.poses.three_poses import bounds_of_three

    return bounds_of_three(scaled, proving, lower=float(best)) or before


def certified_of(scaled: ScaledProblem) -> Certified | None:
    """All dyads of five whole poses or five pairs of a function; None for other problems."""
    if not scaled.one_loop:
        return None
    if scaled.problem.task.has_output.all():
        from grashof.synth.proof.functions.five_pairs import certified_functions

        return certified_functions(scaled)
    if scaled.motion is None:
        return None
    from grashof.synth.proof.poses.five_poses import certified_poses

    return certified_poses(scaled)

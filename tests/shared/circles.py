"""Four-bars closed by circles about A and O4, and points of linkages in the frame of the search."""

import numpy as np

from grashof.analysis import solve_position
from grashof.problems import FourBar, Linkage
from grashof.problems.values.arrays import ComplexArray, FloatArray
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory.burmester import Dyads


def meeting_points(
    a: ComplexArray, o4: complex, r3: float, r4: float, least: float = -np.inf
) -> tuple[ComplexArray, ComplexArray]:
    """Both places of B for places of A, left of A->O4 first; NaN where the circles do not meet.

    With `least` = 0 they come as near as possible there.
    """
    to_o4 = o4 - a
    distance = np.abs(to_o4)
    foot = (distance**2 + r3**2 - r4**2) / (2 * distance)
    with np.errstate(invalid="ignore"):
        height = np.sqrt(np.maximum(r3**2 - foot**2, least))
    ahead = to_o4 / distance
    return a + ahead * (foot + 1j * height), a + ahead * (foot - 1j * height)


def closed(numbers: FloatArray, theta2: FloatArray, side: FloatArray | float) -> tuple[ComplexArray, ...]:
    """A, B and P at driver angles by o2, o4, r2, r3, r4, u, v; B left of A->O4 where `side` is positive."""
    o2, o4, arm = (complex(*numbers[i : i + 2]) for i in (0, 2, 7))
    r2, r3, r4 = numbers[4:7]
    a = o2 + r2 * np.exp(1j * theta2)
    b = np.where(np.asarray(side) > 0, *meeting_points(a, o4, r3, r4, least=0.0))
    return a, b, a + arm * (b - a) / r3


def numbers_of(points: ComplexArray) -> FloatArray:
    """O2, O4, r2, r3, r4, u, v of a linkage that stands at O2, O4, A, B, P."""
    o2, o4, a, b, p = points
    arm = (p - a) * abs(b - a) / (b - a)
    lengths = [abs(a - o2), abs(b - a), abs(b - o4)]
    return np.array([o2.real, o2.imag, o4.real, o4.imag, *lengths, arm.real, arm.imag])


def pivots_of(scaled: ScaledProblem, linkage: FourBar) -> ComplexArray:
    """O2, O4, and A, B, P at the first pose in the frame, from the body's place and the coupler's numbers."""
    task, frame = scaled.problem.task, scaled.frame
    coupler = np.exp(1j * (task.angles[0] - float(linkage.body_angle)))
    p = complex(*task.positions[0])
    a = p - complex(*linkage.coupler_point) * coupler
    every = np.array([complex(*linkage.o2), complex(*linkage.o4), a, a + float(linkage.r3) * coupler, p])
    return (every - frame.origin) / frame.scale


def points_of(scaled: ScaledProblem, linkage: Linkage, theta2: float) -> ComplexArray:
    """O2, O4, A, B, P of a linkage of any kind in the frame, as the search has them, by the judge."""
    state, inward = solve_position(linkage, theta2), scaled.frame.inward
    o2, a, b, p = (complex(inward(place)) for place in (linkage.o2, state.a, state.b, state.p))
    return np.array([o2, scaled.kind.o4_of(linkage, b, scaled.frame), a, b, p])


def radii(positions: ComplexArray, angles: FloatArray, dyads: Dyads) -> FloatArray:
    """Distances (..., N) of moving pivots, carried in the body's own frame, from their ground pivots."""
    own = (dyads.moving - positions[..., 0]) * np.exp(-1j * angles[..., 0])
    places = positions + own[..., None] * np.exp(1j * angles)
    return np.asarray(np.abs(places - dyads.ground[..., None]))

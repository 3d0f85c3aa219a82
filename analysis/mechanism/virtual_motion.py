"""Velocities that a linkage allows, with a limit in dead positions."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.closing import close, operands_of, virtual_rates
from grashof.analysis.mechanism.kinematics import Kinematics, SlideMotion, Turning
from grashof.problems import Linkage


def virtual_motion(
    linkage: Linkage, theta2: npt.ArrayLike, assembly: npt.ArrayLike | None = None
) -> tuple[Kinematics, Kinematics]:
    """Positions with velocities that the linkage allows, and the same at rest.

    The driver turns counter-clockwise by the product of the sines of all transmission angles, so that the
    rates, those of `solve_kinematics` times it, have a limit in a dead position.
    """
    angle = np.asarray(theta2, dtype=np.float64)
    loops, _ = close(linkage.mechanism, operands_of(linkage, assembly), angle)
    shape = np.shape(loops[-1].closed.margin)
    none = np.zeros(shape)
    omega2, rates = virtual_rates(loops)
    moving = [Turning(np.broadcast_to(angle, shape)[()], omega2, none, none)]
    slides: list[SlideMotion | None] = []
    for loop, solved in zip(loops, rates, strict=True):
        turns = solved.turn3, np.broadcast_to(solved.turn4, shape)[()]
        moving += [Turning(*each, none, none) for each in zip(loop.closed.angles, turns, strict=True)]
        has_slide = loop.dyad.row.slides
        slides.append(SlideMotion(loop.travel, solved.travel, none, none) if has_slide else None)
    resting = [Turning(each.theta, none, none, none) for each in moving]
    still = [None if slide is None else SlideMotion(slide.travel, none, none, none) for slide in slides]
    margins = tuple(loop.closed.margin for loop in loops)
    return (
        Kinematics(linkage, tuple(moving), tuple(slides), margins),
        Kinematics(linkage, tuple(resting), tuple(still), margins),
    )

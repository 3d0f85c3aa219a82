"""The joints of a linkage: pins or slides, how they move, and where the frames of links begin."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import DyadKind


class Joint(IntEnum):
    """The joints, in the order of arrays that have an axis for them; linkages of one loop have four.

    One of those at B and O4 is a slide in slider kinds: the ground guides the slider of a slider-crank,
    which has no O4; the block of an inverted one, which turns about O4, guides the rod, so that B is a slide.
    The slider of a six-bar has its slide at D.
    """

    O2 = 0
    A = 1
    B = 2
    O4 = 3
    C = 4
    E = 5
    D = 6


def joints_of(linkage: Linkage) -> tuple[Joint, ...]:
    """The joints that a linkage has."""
    return tuple(map(Joint, range(len(linkage.mechanism.every_joint))))


def slides_of(linkage: Linkage) -> tuple[Joint, ...]:
    """The joints that are slides."""
    return tuple(Joint(k) for k, joint in enumerate(linkage.mechanism.every_joint) if joint.slides)


def pins_of(linkage: Linkage) -> tuple[Joint, ...]:
    """The joints that are pins."""
    return tuple(Joint(k) for k, joint in enumerate(linkage.mechanism.every_joint) if not joint.slides)


def joint_motion(state: Kinematics, joint: int) -> tuple[FloatArray, FloatArray]:
    """Angle (...), rad, and angular velocity of the second link of a joint relative to the first.

    In a slide its travel and the rate of that: of the slider's pin from the foot of O2 on the line of the
    slide, or of B from A along the rod.
    """
    row = state.linkage.mechanism.every_joint[joint]
    first, second = row.links
    slide = state.slides[(second - 3) // 2] if row.slides else None
    if slide is not None:
        return slide.travel, slide.velocity
    angle, rate = state.angular(second)[:2]
    if first == 1:
        return angle, rate
    before, rate_before = state.angular(first)[:2]
    return angle - before, rate - rate_before


def slide_direction(state: Kinematics, link: int = 4) -> FloatArray:
    """Unit vector along a slide, or a rod in its block, shape (..., 2): its slider or block less 90 deg."""
    theta = state.angular(link).theta
    return np.stack([np.sin(theta), -np.cos(theta)], axis=-1)


def slide_normal(state: Kinematics, link: int = 4) -> FloatArray:
    """Unit vector across a slide, to its left, shape (..., 2)."""
    theta = state.angular(link).theta
    return np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def output_rate(state: Kinematics) -> FloatArray:
    """Angular velocity of the last link, rad/s; of a slider its velocity along the slide, length/s."""
    slide = state.slides[-1]
    if slide is not None and state.linkage.mechanism.dyads[-1].kind is DyadKind.RRP:
        return slide.velocity
    return state.turning[-1].omega

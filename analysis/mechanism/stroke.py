"""Strokes: limit positions, swing and time ratio of link 4 in closed form, of any link by its velocity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.extremes import motion_between, unwrapped
from grashof.analysis.mechanism.first_loop import first_loop
from grashof.analysis.mechanism.kinematics import is_slider, virtual_motion
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import last_where, with_extremes
from grashof.problems import Linkage
from grashof.problems.values.arrays import TURN, FloatArray, turned_from

_PANELS = 720


@dataclass(frozen=True, slots=True, eq=False)
class OutputStroke:
    """The two toggle positions in which the output link turns back: O2, A and B lie in one line.

    Parameters
    ----------
    theta2 : ndarray, shape (..., 2), rad
        Driver angle in [0, 2 pi) with links 2 and 3 stretched, and folded; NaN where there is no such
        position, as for an output that turns fully.
    theta4 : ndarray, shape (..., 2), rad
        Output angle there, the second within half a turn of the first.
    b : ndarray, shape (..., 2, 2), length
        B there.
    swing : ndarray, shape (...), rad
        Angle between the two.
    time_ratio : ndarray, shape (...)
        Time of the slow stroke over that of the quick one; NaN if the driver does not turn fully.
    """

    theta2: FloatArray
    theta4: FloatArray
    b: FloatArray
    swing: FloatArray
    time_ratio: FloatArray

    @property
    def chord(self) -> FloatArray:
        """Distance between the two positions of B, shape (...), length."""
        way = self.b[..., 1, :] - self.b[..., 0, :]
        return np.hypot(way[..., 0], way[..., 1])


def output_stroke(linkage: Linkage) -> OutputStroke:
    """Limit positions of link 4 on the linkage's own assembly; see `link_stroke` for others.

    Parameters
    ----------
    linkage : Linkage

    Returns
    -------
    OutputStroke

    Notes
    -----
    Triangles O2-B-O4 with the side O2B = r2 + r3 or |r2 - r3| (Norton, *Design of Machinery*, secs. 3.2,
    3.4). The dead positions of the driver, with links 3 and 4 in line, are the ends of `driver_ranges`.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> stroke = output_stroke(norton)
    >>> np.degrees(stroke.theta2).round(4).tolist(), float(np.degrees(stroke.swing).round(4))
    ([24.1468, 231.3178], 73.7818)
    >>> float(stroke.time_ratio.round(6))
    1.355573
    """
    theta2 = first_loop(linkage).limits() % TURN
    state = solve_position(linkage[..., None], theta2)
    turned = turned_from(state.theta4[..., 1], state.theta4[..., 0])
    theta4 = state.theta4[..., :1] + np.stack([np.zeros_like(turned), turned], axis=-1)
    between = np.diff(theta2, axis=-1)[..., 0] % TURN
    ratio = np.maximum(between, TURN - between) / np.minimum(between, TURN - between)
    return OutputStroke(
        theta2=theta2,
        theta4=theta4,
        b=state.b,
        swing=np.abs(turned),
        time_ratio=np.where(full_rotation(linkage), ratio, np.nan)[()],
    )


@dataclass(frozen=True, slots=True, eq=False)
class LinkStroke:
    """Limit positions and stroke of a link.

    Parameters
    ----------
    theta2 : ndarray, shape (N,), rad
        Driver angles at which the link turns back, ascending.
    value : ndarray, shape (N,), rad or length
        Its direction there, unwrapped from the start of the motion; of a slider its travel.
    stroke : float, rad or length
        Greatest less least value over the motion, its ends included; NaN for a link that turns fully.
    time_ratio : float
        Time of the slow stroke over that of the quick one; NaN if the driver does not turn fully or the link
        does not turn back twice.
    """

    theta2: FloatArray
    value: FloatArray
    stroke: float
    time_ratio: float


def link_stroke(
    linkage: Linkage, link: int | None = None, start: float | None = None, end: float | None = None
) -> LinkStroke:
    """Limit positions of any moving link on the linkage's own assembly, where its velocity changes sign.

    Parameters
    ----------
    linkage, start, end
        As for `extremes`.
    link : int, optional
        The last one by default: the output of a six-bar.

    Returns
    -------
    LinkStroke

    Raises
    ------
    AssemblyError
        The linkage cannot close in between.

    Notes
    -----
    The velocity times the sines of the transmission angles is sampled with all its extremes, so that at most
    one limit position lies between two samples.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> norton = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80)
    >>> found = link_stroke(norton)
    >>> np.degrees([*found.theta2, found.stroke]).round(4).tolist(), round(found.time_ratio, 6)
    ([24.1468, 231.3178, 73.7818], 1.355573)
    """
    start, end, turns = motion_between(linkage, start, end)
    link = linkage.mechanism.links[-1].number if link is None else link
    slides, motion = is_slider(linkage, link), even_motion(linkage, start, end)

    def moving(theta2: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Angle or travel, and its velocity times the sines of the transmission angles."""
        state, _ = virtual_motion(linkage, theta2)
        slide = state.slides[link // 2 - 2] if slides else None
        if slide is not None:
            return slide.travel, slide.velocity
        turning = state.angular(link)
        return turning.theta, turning.omega

    share, _ = with_extremes(lambda at: moving(motion.theta2(at))[1], motion.edges(_PANELS), periodic=turns)
    theta2 = motion.theta2(np.append(share, share[0] + 1) if turns else share)
    raw, velocity = moving(theta2)
    value = unwrapped(theta2, raw, None if slides else TURN)
    rises = velocity > 0
    if not turns:  # the sine vanishes in a dead position of another loop, too
        rises[0], rises[-1] = rises[1], rises[-2]
    back = np.flatnonzero(rises[1:] != rises[:-1])
    first = rises[back]
    limits = last_where(lambda at: (moving(at)[1] > 0) == first, theta2[back], theta2[back + 1])
    there = moving(limits)[0]
    if not slides:
        there = there + TURN * np.round((value[back] - there) / TURN)
    between = np.diff(limits)
    ratio = np.nan
    if turns and len(limits) == 2:
        ratio = float(max(between[0] / (TURN - between[0]), (TURN - between[0]) / between[0]))
    fully = turns and not slides and abs(value[-1] - value[0]) > np.pi
    every = np.concatenate([value, there])
    return LinkStroke(limits, there, np.nan if fully else float(np.ptp(every)), ratio)

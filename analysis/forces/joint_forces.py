"""Forces in the joints of a linkage, dyad after dyad from the last one to the driver."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from grashof.analysis.mechanism.closing import HostedDyad, dyads_of
from grashof.analysis.mechanism.dyad import Closed, Demands, Vector
from grashof.analysis.mechanism.kinematics import Kinematics
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.linkages.mechanism import DyadKind


class Need(NamedTuple):
    """The force, and moment about the origin of its frame, that joints and drive must exert on a link."""

    x: FloatArray
    y: FloatArray
    turn: FloatArray

    def eased(self, arm: Vector, force: Vector, moment: FloatArray) -> Need:
        """The rest where a force on an arm from the origin, and a moment, act besides."""
        return Need(
            self.x - force[0], self.y - force[1], self.turn - (arm[0] * force[1] - arm[1] * force[0]) - moment
        )


class PlacedDyad(NamedTuple):
    """A dyad in a motion; arms of C and D (of a slide E) from the origins of their hosts' frames, or O2."""

    dyad: HostedDyad
    closed: Closed
    arms: tuple[Vector, Vector]


class Frames(NamedTuple):
    """How the links of a motion lie: directions of the u-axes of their frames, and the dyads."""

    axes: dict[int, Vector]
    dyads: list[PlacedDyad]

    def arm(self, link: int, at: Vector) -> Vector:
        """A point of a moving link from the origin of its frame, in global axes."""
        (u, v), (cosine, sine) = at, self.axes[link]
        return u * cosine - v * sine, u * sine + v * cosine


def frames_of(state: Kinematics) -> Frames:
    """Directions of all links of a motion, and its dyads."""
    theta2 = state.theta2
    frames = Frames({2: (np.cos(theta2), np.sin(theta2))}, [])
    for loop, dyad in enumerate(dyads_of(state.linkage)):
        first, kind = 2 * loop + 3, dyad.row.kind
        three, four = state.angular(first).theta, state.angular(first + 1).theta
        cos3, sin3, cos4, sin4 = np.cos(three), np.sin(three), np.cos(four), np.sin(four)
        slide = state.slides[loop]
        reach = slide.travel if kind is DyadKind.RPR and slide is not None else np.zeros(())
        frames.axes[first] = cos3, sin3
        frames.axes[first + 1] = (sin4, -cos4) if kind is DyadKind.RRP else (cos4, sin4)
        c = frames.arm(dyad.row.hosts[0], dyad.at[0])
        if kind is DyadKind.RRP:  # its host is the ground
            pin = state.origin(first + 1).position - state.linkage.o2
            d = pin[..., 0], pin[..., 1]
        else:
            host = dyad.row.hosts[1]
            d = dyad.at[1] if host == 1 else frames.arm(host, dyad.at[1])
        closed = Closed(cos3, sin3, cos4, sin4, state.margins[loop], reach)
        frames.dyads.append(PlacedDyad(dyad, closed, (c, d)))
    return frames


class JointForces(NamedTuple):
    """Forces as in `Dynamics`, by joint those across slides and their moments, and the drive torque."""

    forces: list[Vector]
    slides: dict[int, Vector]
    torque: FloatArray


def joint_forces(frames: Frames, needs: Mapping[int, Need], moments: FloatArray) -> JointForces:
    """Forces in the joints that meet the needs of all moving links; `moments` (J, ...) as in `Dynamics`.

    Of a dyad the balance of both links gives the force between them (`grashof.analysis.mechanism.dyad`);
    those on its hosts follow, and reduce the needs of these.
    """
    left, on_links, slides = dict(needs), list[Vector](), dict[int, Vector]()
    for loop in reversed(range(len(frames.dyads))):
        (dyad, closed, arms), first, joint = frames.dyads[loop], 2 * loop + 3, 3 * loop + 1
        in_c, in_e, in_d = moments[joint : joint + 3]
        three, four = left[first], left[first + 1]
        host_c, host_d = dyad.row.hosts
        demands = Demands(three.turn - in_c, four.turn, (four.x, four.y), in_e, in_d)
        at_e, slide_moment = dyad.sizes.force(closed, demands)
        at_c, at_d = (at_e[0] - three.x, at_e[1] - three.y), (four.x + at_e[0], four.y + at_e[1])
        left[host_c] = left[host_c].eased(arms[0], at_c, -in_c)
        if dyad.row.slides:
            on_rod = dyad.row.kind is DyadKind.RPR
            x, y = (-at_e[0], -at_e[1]) if on_rod else at_d
            across = x * closed.cos4 + y * closed.sin4
            slides[joint + 1 if on_rod else joint + 2] = across, slide_moment
        if host_d != 1:
            at_d = -at_d[0], -at_d[1]
            left[host_d] = left[host_d].eased(arms[1], at_d, -in_d)
        on_links = [at_c, at_e, at_d, *on_links]
    driver = left[2]
    return JointForces([(driver.x, driver.y), *on_links], slides, driver.turn - moments[0])

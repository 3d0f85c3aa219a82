"""Masses, centres and inertias of the moving links, and their common centre of mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.forces.bars import bars_of
from grashof.analysis.mechanism.kinematics import Kinematics, PointMotion
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import FloatArray, frozen_array
from grashof.problems.values.errors import wrong_value
from grashof.problems.values.value_bases import ReadOnly


@dataclass(frozen=True, slots=True, init=False, eq=False)
class Body(ReadOnly):
    """Mass properties of a link, in the link's frame.

    Parameters
    ----------
    mass : array_like, shape (...), kg
    inertia : array_like, shape (...), kg length^2
        About the centre of mass.
    centre : array_like, shape (..., 2), length
        Centre of mass (u, v): origin O2, A, O4, C or D, u towards A, B, B, E or E, v to its left; of a
        slider from B or E, u along the slide.
    parts : tuple of Body
        That it was put together from, whose places section forces depend on; none of a single one.
    """

    mass: FloatArray
    inertia: FloatArray
    centre: FloatArray
    parts: tuple[Body, ...]

    def __init__(
        self,
        mass: npt.ArrayLike,
        inertia: npt.ArrayLike = 0.0,
        centre: npt.ArrayLike = (0.0, 0.0),
        parts: tuple[Body, ...] = (),
    ) -> None:
        object.__setattr__(self, "parts", parts)
        for name, value in (("mass", mass), ("inertia", inertia), ("centre", centre)):
            array = frozen_array(value)
            if not np.isfinite(array).all():
                raise wrong_value(name, value, "a finite number")
            if name != "centre" and np.any(array < 0):
                raise wrong_value(name, value, "a number from zero")
            if name == "centre" and np.shape(array)[-1:] != (2,):
                raise ProblemError(f"centre has shape {np.shape(array)}; it must be (..., 2)")
            object.__setattr__(self, name, array)

    def __add__(self, other: Body) -> Body:
        """Two bodies fixed to the same link, as one (Steiner's theorem)."""
        mass = np.asarray(self.mass + other.mass)
        share = np.divide(other.mass, mass, out=np.zeros(mass.shape), where=mass > 0)
        apart = other.centre - self.centre
        reduced = share * self.mass
        return Body(
            mass,
            self.inertia + other.inertia + reduced * (apart**2).sum(axis=-1),
            self.centre + share[..., None] * apart,
            (*self.pieces, *other.pieces),
        )

    @property
    def pieces(self) -> tuple[Body, ...]:
        """Its parts, or itself where it has none."""
        return self.parts or (self,)


@dataclass(frozen=True, slots=True, init=False, eq=False)
class Masses:
    """The moving links as bodies; a load at P belongs to the link that carries it.

    Parameters
    ----------
    crank, coupler, output : Body
        Links 2, 3 and 4.
    *others : Body
        Links 5 and 6 of a six-bar.

    Examples
    --------
    >>> float(Masses(Body(1.0), Body(2.0), Body(3.0), Body(0.5), Body(0.0)).of(5).mass)
    0.5
    """

    bodies: tuple[Body, ...]

    def __init__(self, crank: Body, coupler: Body, output: Body, *others: Body) -> None:
        object.__setattr__(self, "bodies", (crank, coupler, output, *others))

    @property
    def crank(self) -> Body:
        """Link 2."""
        return self.bodies[0]

    @property
    def coupler(self) -> Body:
        """Link 3."""
        return self.bodies[1]

    @property
    def output(self) -> Body:
        """Link 4."""
        return self.bodies[2]

    def of(self, link: int) -> Body:
        """The body of a moving link: 2, 3, ..."""
        return self.bodies[link - 2]

    def by_link(self, linkage: Linkage) -> dict[int, Body]:
        """The bodies of the moving links of a linkage, by their numbers.

        Raises
        ------
        ProblemError
            There are fewer bodies than moving links, or a body with a mass belongs to none.
        """
        numbers = [link.number for link in linkage.mechanism.links[1:]]
        beyond = [np.any(body.mass) or np.any(body.inertia) for body in self.bodies[len(numbers) :]]
        if len(self.bodies) < len(numbers) or any(beyond):
            wanted = f"{len(numbers)} for a {linkage.mechanism.word}: links {_listed(numbers)}"
            raise ProblemError(f"masses has {len(self.bodies)} bodies; it must have {wanted}")
        return dict(zip(numbers, self.bodies, strict=False))

    @property
    def total(self) -> FloatArray:
        """Mass of all moving links, shape (...), kg."""
        first, *others = self.bodies
        return np.asarray(sum((body.mass for body in others), first.mass))

    def with_body(self, link: int, body: Body) -> Masses:
        """The same with one more body fixed to a link."""
        bodies = list(self.bodies)
        if not 2 <= link < len(bodies) + 2:
            raise wrong_value("link", link, f"that of a body, 2 to {len(bodies) + 1}")
        bodies[link - 2] = bodies[link - 2] + body
        return Masses(*bodies)

    def with_payload(self, mass: npt.ArrayLike, at: npt.ArrayLike, link: int = 3) -> Masses:
        """The same with a point mass, as at ``linkage.coupler_point``: on the coupler, or another link."""
        return self.with_body(link, Body(mass, 0.0, at))


#: Links that have no mass.
WEIGHTLESS = Masses(*[Body(0.0)] * 5)


def uniform_bar(length: npt.ArrayLike, mass_per_length: npt.ArrayLike, width: npt.ArrayLike = 0.0) -> Body:
    """A straight uniform bar along its link, from joint to joint.

    Parameters
    ----------
    length : array_like, shape (...), length
    mass_per_length : array_like, shape (...), kg/length
        Section times density.
    width : array_like, shape (...), length
        In the plane of motion; none for a slender bar.

    Examples
    --------
    >>> crank = uniform_bar(1.1938, 0.2 * 0.2 * 7800)
    >>> float(crank.mass.round(4)), float(crank.inertia.round(4))
    (372.4656, 44.2352)
    """
    length = np.asarray(length, dtype=np.float64)
    mass = length * mass_per_length
    return Body(
        mass,
        mass * (length**2 + np.square(width)) / 12,
        np.stack([length / 2, np.zeros_like(length)], axis=-1),
    )


def triangular_plate(base: npt.ArrayLike, apex: npt.ArrayLike, mass_per_area: npt.ArrayLike) -> Body:
    """A uniform triangular plate on a link: a coupler A-B-P.

    Parameters
    ----------
    base : array_like, shape (...), length
        Side along the link, from its origin: r3 for a coupler.
    apex : array_like, shape (..., 2), length
        Third corner in the link's frame, as ``linkage.coupler_point``.
    mass_per_area : array_like, shape (...), kg/length^2
        Thickness times density.

    Notes
    -----
    The inertia about the centroid is m (a^2 + b^2 + c^2) / 36.

    Examples
    --------
    >>> plate = triangular_plate(3.0, (0.0, 3.0), 2.0)
    >>> float(plate.mass), float(plate.inertia), plate.centre.tolist()
    (9.0, 9.0, [1.0, 1.0])
    """
    base, apex = np.asarray(base, dtype=np.float64), np.asarray(apex, dtype=np.float64)
    u, v = apex[..., 0], apex[..., 1]
    mass = base * np.abs(v) / 2 * mass_per_area
    squares = base**2 + u**2 + v**2 + (u - base) ** 2 + v**2
    return Body(mass, mass * squares / 36, np.stack(np.broadcast_arrays((base + u) / 3, v / 3), axis=-1))


def uniform_bars(
    linkage: Linkage,
    mass_per_length: npt.ArrayLike,
    payload: npt.ArrayLike = 0.0,
    widths: npt.ArrayLike = 0.0,
) -> Masses:
    """All moving links that are bars (see `bars_of`) as uniform ones, with a payload at P.

    Sliders and blocks have no mass then.

    Parameters
    ----------
    linkage : Linkage
    mass_per_length : array_like, shape () or (N,), kg/length
        One for all, or one each for links 2, 3, 4, of a six-bar to 6.
    payload : array_like, shape (...), kg
    widths : array_like, shape () or (N,), length
        In the plane of motion; none for slender bars.
    """
    links = [link.number for link in linkage.mechanism.links[1:]]
    each, wide = (
        np.broadcast_to(np.asarray(given, dtype=np.float64), len(links))
        for given in (mass_per_length, widths)
    )
    bodies = dict.fromkeys(links, Body(0.0))
    for link, bar in bars_of(linkage).items():
        body = uniform_bar(bar.reach, each[link - 2], wide[link - 2])
        bodies[link] = Body(body.mass, body.inertia, bar.middle)  # where it lies on its link
    bars = Masses(*bodies.values())
    return loaded(bars, linkage, payload) if np.any(np.asarray(payload) != 0) else bars


def loaded(masses: Masses, linkage: Linkage, payload: npt.ArrayLike) -> Masses:
    """The same with a payload at P."""
    return masses.with_payload(payload, linkage.coupler_point, linkage.mechanism.carries)


def given_masses(
    linkage: Linkage,
    masses: Sequence[float],
    inertias: Sequence[float],
    centres: Sequence[Sequence[float]] | None = None,
) -> Masses:
    """Moving links with known masses and inertias.

    Parameters
    ----------
    linkage : Linkage
    masses, inertias : sequence of float, kg and kg length^2
        Three for links 2, 3 and 4, five of a six-bar; inertias about the centres of mass.
    centres : sequence of pairs, length, optional
        In the links' frames; by default halfway between the joints of a bar, halfway along the rod of an
        inverted slider-crank (see `bars_of`), at B or E of a slider and at O4 of a block.
    """
    links = [link.number for link in linkage.mechanism.links[1:]]
    for name, values in (("masses", masses), ("inertias", inertias), ("centres", centres)):
        if values is not None and len(values) != len(links):
            wanted = f"{_WORDS[len(links)]}, for links {_listed(links)}"
            raise ProblemError(f"{name} has {len(values)} entries; it must have {wanted}")
    bars, pinned = bars_of(linkage), np.zeros(2)
    halfway = [bars[link].middle if link in bars else pinned for link in links]
    places = halfway if centres is None else [np.asarray(centre, dtype=np.float64) for centre in centres]
    return Masses(*(Body(*each) for each in zip(masses, inertias, places, strict=True)))


_WORDS = {3: "three", 5: "five"}


def _listed(numbers: Sequence[int]) -> str:
    *most, last = map(str, numbers)
    return f"{', '.join(most)} and {last}"


def system_centre(masses: Masses, state: Kinematics) -> PointMotion:
    """Motion of the centre of mass of all moving links.

    Parameters
    ----------
    masses : Masses
    state : Kinematics

    Returns
    -------
    PointMotion
        Its acceleration times the total mass is the force that the motion needs from outside.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> jack = FourBar(o2=(0, 1.5), o4=(4, 4.5), r2=1.1938, r3=3.7719, r4=3.048762)
    >>> bars = uniform_bars(jack, (312, 312, 314))
    >>> from grashof.analysis import solve_kinematics
    >>> system_centre(bars, solve_kinematics(jack, np.radians(90))).position.round(6).tolist()
    [1.382152, 4.431897]
    """
    total = masses.total
    if not np.all(total > 0):
        raise ProblemError("the links have no mass, so no centre of mass")
    moments = np.zeros(())
    for link, body in masses.by_link(state.linkage).items():
        centre, share = state.point(link, body.centre), np.asarray(body.mass / total)[..., None]
        parts = (centre.position, centre.velocity, centre.acceleration, centre.jerk)
        moments = moments + share * np.stack(parts)
    return PointMotion(*moments)

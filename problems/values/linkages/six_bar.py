"""The six-bar as a value: a driven four-bar, and one more dyad between two of its links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy.typing as npt

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.errors import ProblemError, shown, wrong_value
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.problems.values.value_bases import set_fields

_SIX_BARS = tuple(row for row in MECHANISMS if len(row.dyads) > 1)


@dataclass(frozen=True, slots=True, init=False, eq=False, repr=False)
class SixBar(Linkage):
    """A planar six-bar linkage whose driver lies in a four-bar loop, or a batch of them.

    Links 1 to 4 are those of a four-bar (see `FourBar`). Two more close a second loop: link 5 (C-E) and link
    6 (D-E) between two of them, or a slider instead of link 6.

    Parameters
    ----------
    o2, o4 : array_like, shape (..., 2), length
        Ground pivots of the driver and of link 4.
    r2, r3, r4 : array_like, shape (...), length
        Lengths O2A, AB and O4B.
    c : array_like, shape (..., 2), length
        C in the frame of the link that carries it.
    d : array_like, shape (..., 2), length, optional
        D likewise; the frame of the ground is the global one. Not with a slide.
    r5, r6 : array_like, shape (...), length
        Lengths CE and DE; a slide has no r6.
    offset_2 : array_like, shape (...), length, optional
        With a slide: of its line from O2, positive to the left of its direction.
    slide_angle_2 : array_like, shape (...), rad, optional
        Direction of the slide, counter-clockwise from +x; its presence makes link 6 a slider on the ground.
    coupler_point : array_like, shape (..., 2), length
        P in the frame of `point_link`: origin O2, A, O4, C or D, u towards A, B, B, E or E, v to its left; of
        a slider the origin is E, u along the slide.
    assembly : array_like, shape (...)
        Sign of sin(theta4 - theta3): +1 when B lies left of the directed line A->O4, else -1.
    assembly_2 : array_like, shape (...)
        +1 when E lies left of the directed line C->D, or ahead of C along the slide; else -1.
    body_angle : array_like, shape (...), rad
        Orientation of the guided body minus that of `point_link`.
    hosts : pair of int
        The links that carry C and D: Stephenson III (3, 1), Stephenson I (2, 4), Watt I (2, 3) or (3, 4),
        Watt II (2, 1) or (4, 1); with a slide (3, 1), (2, 1) or (4, 1).
    point_link : int
        The link that carries P, 2 to 6.

    Raises
    ------
    ProblemError
        Hosts other than these, `d` and `r6` together with a slide or neither, or values `FourBar` refuses.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 2.11. Stephenson II, and drivers outside the four-bar loop, have no
    such form.

    Examples
    --------
    >>> leg = SixBar((0, 0), (4, 0), 1, 4, 3, c=(5, 1), d=(6, 2), r5=3, r6=3, hosts=(3, 1), point_link=5)
    >>> leg.mechanism.word, leg.mechanism.joints["d"]
    ('stephenson-3', (1, 6))
    """

    mechanism: Mechanism

    o2: FloatArray
    o4: FloatArray
    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    c: FloatArray
    d: FloatArray
    r5: FloatArray
    r6: FloatArray
    offset_2: FloatArray
    slide_angle_2: FloatArray
    coupler_point: FloatArray
    assembly: FloatArray
    assembly_2: FloatArray
    body_angle: FloatArray

    def __init__(
        self,
        o2: npt.ArrayLike,
        o4: npt.ArrayLike,
        r2: npt.ArrayLike,
        r3: npt.ArrayLike,
        r4: npt.ArrayLike,
        *,
        c: npt.ArrayLike,
        d: npt.ArrayLike | None = None,
        r5: npt.ArrayLike,
        r6: npt.ArrayLike | None = None,
        offset_2: npt.ArrayLike | None = None,
        slide_angle_2: npt.ArrayLike | None = None,
        coupler_point: npt.ArrayLike = (0.0, 0.0),
        assembly: npt.ArrayLike = 1,
        assembly_2: npt.ArrayLike = 1,
        body_angle: npt.ArrayLike = 0.0,
        hosts: Sequence[int],
        point_link: int = 5,
    ) -> None:
        slides = slide_angle_2 is not None
        offset_2 = 0.0 if slides and offset_2 is None else offset_2
        given: dict[str, Any] = {"o2": o2, "o4": o4, "r2": r2, "r3": r3, "r4": r4, "c": c, "d": d}
        given |= {"r5": r5, "r6": r6, "offset_2": offset_2, "slide_angle_2": slide_angle_2}
        given |= {"coupler_point": coupler_point, "body_angle": body_angle}
        given |= {"assembly": assembly, "assembly_2": assembly_2}
        row = six_bar(hosts, slides=slides, point_link=point_link)
        names = [parameter.name for parameter in row.parameters]
        for name, value in given.items():
            if (value is None) == (name in names):
                with_slide = "with slide_angle_2" if slides else "without slide_angle_2"
                raise ProblemError(f"{name} is {'missing' if value is None else 'given'} {with_slide}")
        set_fields(self, mechanism=row)
        self._keep(*(given[name] for name in names))

    @property
    def choices(self) -> dict[str, Any]:
        """Hosts of the second dyad, and the link that carries P."""
        return {"hosts": list(self.mechanism.dyads[1].hosts), "point_link": self.mechanism.carries}


def six_bar(hosts: Sequence[int], *, slides: bool = False, point_link: int = 5) -> Mechanism:
    """The six-bar whose `hosts` carry C and D and whose `point_link` carries P; link 6 may be a slider."""
    rows = [row for row in _SIX_BARS if row.dyads[1].slides == slides]
    if not 2 <= point_link <= 6 or isinstance(point_link, bool):
        raise wrong_value("point_link", point_link, "the number of a moving link, 2 to 6")
    for row in rows:
        if list(row.dyads[1].hosts) == list(hosts):
            return Mechanism(row.word, row.dyads, int(point_link))
    allowed = ", ".join(str(list(row.dyads[1].hosts)) for row in rows)
    if slides:
        on = "a slide lies on the ground, so it must be one of"
        raise ProblemError(f"hosts is {shown(hosts)}; {on} {allowed}")
    raise wrong_value("hosts", hosts, f"one of {allowed}")

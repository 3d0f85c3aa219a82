"""Two outputs from one crank: the swings of two links of a six-bar, with their time ratios."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import finite_number, noted, refuse
from grashof.problems.values.errors import ProblemError, shown, wrong_value
from grashof.problems.values.linkages.mechanism import MECHANISMS, Mechanism
from grashof.problems.values.tasks.output_task import OF_POINTS, OutputTask
from grashof.problems.values.tasks.stroke_task import most_ratio, rocker_swing, slow_over_quick
from grashof.problems.values.text import counted
from grashof.problems.values.value_bases import set_fields

LINKS = (4, 6)  # that are outputs
# Kinds whose links 4 and 6 both turn about the ground: link 4 drives the second four-bar, or the crank does.
TANDEM_HOSTS = ((4, 1), (2, 1))
TANDEM = tuple(
    dict.fromkeys(row.word for row in MECHANISMS if row.dyads[1:] and row.dyads[1].hosts in TANDEM_HOSTS)
)


@dataclass(frozen=True, slots=True)
class LinkSwing:
    """Swing of one of two outputs, and its time ratio.

    Parameters
    ----------
    link : int
        The link that swings, 4 or 6.
    swing : float, rad
        Greatest less least angle of the link over the turn, below half a turn.
    time_ratio : float, optional
        Time of its slow stroke over that of its quick one, the driver turning steadily; from 1 on. Free by
        default.

    Raises
    ------
    ProblemError
        Another link; a number that no linkage can have.

    Examples
    --------
    >>> LinkSwing.from_degrees(link=4, swing_deg=90).time_ratio is None
    True
    """

    link: int
    swing: float
    time_ratio: float | None = None

    def __post_init__(self) -> None:
        wrong: list[str] = []
        with noted(wrong):
            if isinstance(self.link, bool) or self.link not in LINKS:
                raise ProblemError(f"link is {shown(self.link)}; it must be 4 or 6, the links that swing")
        with noted(wrong):
            set_fields(self, swing=rocker_swing(self.swing))
        with noted(wrong):
            ratio = self.time_ratio
            set_fields(self, time_ratio=None if ratio is None else slow_over_quick(ratio))
        refuse(wrong)

    @classmethod
    def from_degrees(cls, *, link: int, swing_deg: float, time_ratio: float | None = None) -> LinkSwing:
        """The same with its swing in degrees, as problem files write it."""
        return cls(link, float(np.radians(finite_number(swing_deg, "swing_deg"))), time_ratio)


@dataclass(frozen=True, slots=True, init=False, eq=False)
class TandemTask(OutputTask):
    """Two rockers that one crank swings, such as those of a tandem wiper: links 4 and 6 of a Watt II.

    Its two targets are the limit positions of link 4: its slow stroke goes from the first to the last. Place
    and scale of the linkage are free.

    Parameters
    ----------
    strokes : sequence of LinkSwing
        One of link 4, one of link 6.

    Raises
    ------
    ProblemError
        Other than two outputs, or both of one link; a time ratio that no linkage can have.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 2.11: two four-bars in series. The second is driven by link 4, or by
    the crank.

    Examples
    --------
    >>> wiper = TandemTask([LinkSwing.from_degrees(link=k, swing_deg=s) for k, s in ((4, 90), (6, 85))])
    >>> np.degrees(wiper.swings).round(9).tolist(), wiper.usual_mechanism
    ([90.0, 85.0], ('watt-2',))
    """

    kind: ClassVar[Literal["stroke"]] = "stroke"
    target: ClassVar[Literal["limit position"]] = "limit position"
    usual_mechanism: ClassVar[tuple[str, ...]] = TANDEM
    kinds: ClassVar[tuple[str, ...]] = TANDEM
    limits_size = False  #: The distance of O2 and O4 does not limit a linkage that reaches to D.
    without: ClassVar[tuple[str, ...]] = OF_POINTS

    strokes: tuple[LinkSwing, LinkSwing]
    swings: tuple[float, float] = field(init=False)
    time_ratios: tuple[float | None, float | None] = field(init=False)
    timing: FloatArray | None = field(init=False)
    closed: bool = field(init=False)
    within: FloatArray | None = field(init=False)
    reference: float = field(init=False)  # length that counts as the size

    def __init__(self, strokes: Sequence[LinkSwing]) -> None:
        first, second = stated = _one_of_each(strokes)
        kept: dict[str, Any] = {"timing": None, "closed": True, "within": None, "reference": 1.0}
        kept |= {"strokes": stated, "swings": (first.swing, second.swing)}
        set_fields(self, **kept, time_ratios=(first.time_ratio, second.time_ratio))
        refuse(
            [
                f"stroke.time_ratio of link {each.link} is {each.time_ratio:.6g}; it must be below {most:.6g}"
                for each, most in zip(stated, self._most_ratios, strict=True)
                if each.time_ratio is not None and not each.time_ratio < most
            ]
        )

    @property
    def described(self) -> str:
        """As files state it."""
        return 'kind = "stroke" with two outputs'

    def output_links(self, mechanism: Mechanism) -> tuple[int, ...]:  # noqa: ARG002
        """Both."""
        return LINKS

    def exact_for(self, freedoms: int) -> bool:  # noqa: ARG002
        """Yes, whatever the kind."""
        return True

    @property
    def _most_ratios(self) -> tuple[float, float]:
        """Time ratios below which those of links 4 and 6 lie."""
        first, second = (most_ratio(swing) for swing in self.swings)
        if self.time_ratios[0] is None:
            second = max(first, second)
        return first, second


def _one_of_each(strokes: Sequence[LinkSwing]) -> tuple[LinkSwing, LinkSwing]:
    """Strokes of links 4 and 6 in this order; `ProblemError` for others."""
    if isinstance(strokes, str) or not all(isinstance(each, LinkSwing) for each in strokes):
        raise wrong_value("stroke", strokes, "two LinkSwing, of links 4 and 6")
    by_link = {each.link: each for each in strokes}
    if len(strokes) == len(by_link) == len(LINKS):
        first, second = (by_link[link] for link in LINKS)
        return first, second
    if len(strokes) != len(LINKS):
        found = f"stroke has {counted(len(strokes), 'table')} [[stroke]]"
        raise ProblemError(f"{found}; it must have two, of links 4 and 6, or be one table [stroke]")
    (link,) = by_link
    raise ProblemError(f"stroke has link {link} twice; it must have one table for link 4 and one for link 6")

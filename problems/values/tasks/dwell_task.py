"""The dwell task: the output stands still over part of a turn of the driver, and swings or travels."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import finite_number, noted, number_within, refuse, size_number
from grashof.problems.values.errors import ProblemError
from grashof.problems.values.linkages.mechanism import MECHANISMS
from grashof.problems.values.tasks.output_task import OF_POINTS, OutputTask
from grashof.problems.values.value_bases import set_fields

DWELLS_DEG, SWINGS_DEG = np.array([1.0, 350.0]), np.array([0.1, 179.0])
BANDS, USUAL_BAND = np.array([1e-9, 0.5]), 0.05  # shares of the swing or stroke
SWING_WITHIN = float(np.radians(0.01))  # rad, or share of the stroke
USUAL_TOLERANCE = 2e-4  # of dimensions as made, over r1, where a problem states none
# Kinds with a dwell: D of the last dyad on the ground, C on the coupler.
DWELL_HOSTS = (3, 1)
DWELLING = tuple(
    dict.fromkeys(row.word for row in MECHANISMS if row.dyads[1:] and row.dyads[1].hosts == DWELL_HOSTS)
)


@dataclass(frozen=True, slots=True, init=False, eq=False)
class DwellTask(OutputTask):
    """A dwell of the last link of a six-bar, and its swing or stroke over a full turn of the driver.

    Its two targets are the ends of the dwell, which may lie anywhere in the turn. The position of the linkage
    is free, and so is its scale unless a stroke is given.

    Parameters
    ----------
    dwell : float, rad
        Driver rotation over which the output stands still.
    swing : float, rad, optional
        Greatest less least angle of link 6 over the turn, met to 0.01 deg.
    stroke : float, length, optional
        Greatest less least travel of a slide, met to 1.7e-4 of itself; either this or the swing is given.
    band : float, rad or length, optional
        Greatest less least output within the dwell, at most; by default a twentieth of the swing or
        stroke. It is made least in any case.

    Raises
    ------
    ProblemError
        Both of swing and stroke, or neither; a number out of range; a band wider than the swing or stroke.

    Notes
    -----
    Norton, *Design of Machinery*, sec. 3.9: C traces nearly an arc of a circle about E while link 6 dwells.

    Examples
    --------
    >>> task = DwellTask.from_degrees(dwell_deg=90, swing_deg=45)
    >>> len(task), round(float(np.degrees(task.dwell)), 9), task.usual_mechanism
    (2, 90.0, ('stephenson-3',))
    """

    kind: ClassVar[Literal["dwell"]] = "dwell"
    target: ClassVar[Literal["end of the dwell"]] = "end of the dwell"
    usual_mechanism: ClassVar[tuple[str, ...]] = DWELLING
    kinds: ClassVar[tuple[str, ...]] = DWELLING
    limits_size = False  #: A dwell has no size to compare with.
    without: ClassVar[tuple[str, ...]] = (*OF_POINTS, "d")

    dwell: float
    swing: float | None
    stroke: float | None
    band: float | None
    timing: FloatArray | None = field(init=False)
    closed: bool = field(init=False)
    within: FloatArray | None = field(init=False)
    reference: float = field(init=False)  # length that counts as the size where the scale is free

    def __init__(
        self,
        *,
        dwell: float,
        swing: float | None = None,
        stroke: float | None = None,
        band: float | None = None,
    ) -> None:
        kept: dict[str, Any] = {"timing": None, "closed": True, "within": None, "reference": 1.0}
        kept |= {"swing": None, "stroke": None, "band": None}
        wrong: list[str] = []
        with noted(wrong):
            kept["dwell"] = _angle(dwell, DWELLS_DEG, "dwell_deg")
        with noted(wrong):
            self.refuse_both(swing, stroke)
            if swing is not None:
                kept["swing"] = _angle(swing, SWINGS_DEG, "swing_deg")
                if band is not None:
                    kept["band"] = _angle(band, BANDS * float(np.degrees(kept["swing"])), "band_deg")
            if stroke is not None:
                kept["stroke"] = size_number(stroke, "dwell.stroke")
                if band is not None:
                    kept["band"] = _within(band, BANDS * kept["stroke"], "band")
        refuse(wrong)
        set_fields(self, **kept)

    @classmethod
    def from_degrees(
        cls,
        *,
        dwell_deg: float,
        swing_deg: float | None = None,
        stroke: float | None = None,
        band_deg: float | None = None,
        band: float | None = None,
    ) -> DwellTask:
        """Task as problem files write it: angles in degrees, `band_deg` of a swing and `band` of a stroke."""
        of_swing = stroke is None
        if (band if of_swing else band_deg) is not None:
            given, key, other = (
                ("band", "swing_deg", "band_deg") if of_swing else ("band_deg", "stroke", "band")
            )
            raise ProblemError(f"dwell.{given} does not go with {key}; use {other}")
        if dwell_deg is None:
            raise ProblemError("dwell.dwell_deg is missing")
        angles = {"dwell_deg": dwell_deg, "swing_deg": swing_deg, "band_deg": band_deg}
        dwell, swing, of_angle = (
            None if angle is None else float(np.radians(finite_number(angle, f"dwell.{key}")))
            for key, angle in angles.items()
        )
        return cls(dwell=dwell or 0.0, swing=swing, stroke=stroke, band=of_angle if of_swing else band)

    @property
    def most_band(self) -> float:
        """The band, stated or by default, rad or length."""
        return USUAL_BAND * self.output_size if self.band is None else self.band

    @property
    def output_size(self) -> float:
        """The swing (rad) or the stroke (length)."""
        return float(self.stroke or self.swing or 0.0)

    def exact_for(self, freedoms: int) -> bool:  # noqa: ARG002
        """Yes, whatever the kind."""
        return True

    @property
    def usual_objective(self) -> dict[str, float]:
        """The least band with manufacturing tolerances: thousandths of a degree cannot be built."""
        return {"transmission": 0.0, "band_made": 1.0}


def _angle(angle: float, limits_deg: FloatArray, key: str) -> float:
    """An angle in rad, checked against limits in deg."""
    deg = float(np.degrees(finite_number(angle, f"dwell.{key}")))
    return float(np.radians(_within(deg, limits_deg, key)))


def _within(number: float, limits: FloatArray, key: str) -> float:
    low, high = limits.tolist()
    return number_within(number, low, high, f"dwell.{key}")

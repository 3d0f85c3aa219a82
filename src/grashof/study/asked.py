"""The options of an analysis, from the command line or Python."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import ProblemError
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.checks import number_within, positive_number, whole_number
from grashof.problems.values.errors import wrong_value
from grashof.study.on_request import FIT_POINTS, ON_REQUEST, STEP

_MOST_ROWS, _MOST_PLACES, _MOST_POINTS = 20_000, 36, 1001
_MOST_DEGREES = 1e6


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """The options of an analysis: its additional results.

    Parameters
    ----------
    speed_rpm : float, optional
        Of the driver, counter-clockwise; by default that of the file, or else 1 rad/s.
    seconds, step : float, s, optional
        Length of a history over time, and its step, `STEP` by default. With `release_deg` that of the free
        motion, and there is no history.
    start_deg : float, deg, optional
        Driver angle at its beginning. By default 0; of a driver that does not turn fully the end of its
        first range, so that the history goes all through it.
    at_deg : tuple of float, deg
        Driver angles at which the linkage is examined closely.
    dwell_deg : float, deg, optional
        The band within which link 4 counts as dwelling.
    release_deg, release_rpm : float, deg and rpm, optional
        Driver angle at which the linkage is released, and the driver's speed there: 0 by default.
    balance : bool
        Whether counterweights are sought.
    flywheel : float, optional
        Fluctuation of the driver's speed that the flywheel has to keep: largest less least speed, as a share
        of the mean.
    tolerance : float, length, optional
        Deviation of each dimension.
    sections : tuple of str
        Of `ON_REQUEST`.
    fit_from_deg, fit_to_deg : float, deg, optional
        Driver angles between which the paths are fitted; they also request that section. By default the task
        motion of a design from a list, or else the entire motion of the driver.
    fit_points : int
        Number of points that are fitted, evenly spaced in the driver angle.

    Raises
    ------
    ProblemError
        A number is not finite or out of range, there are more than 20 000 rows, or a name is unknown.
    """

    speed_rpm: float | None = None
    seconds: float | None = None
    step: float | None = None
    start_deg: float | None = None
    at_deg: tuple[float, ...] = ()
    dwell_deg: float | None = None
    release_deg: float | None = None
    release_rpm: float | None = None
    balance: bool = False
    flywheel: float | None = None
    tolerance: float | None = None
    sections: tuple[str, ...] = ()
    fit_from_deg: float | None = None
    fit_to_deg: float | None = None
    fit_points: int = FIT_POINTS

    def __post_init__(self) -> None:
        for name in ("start_deg", "fit_from_deg", "fit_to_deg"):
            if getattr(self, name) is not None:
                number_within(getattr(self, name), -_MOST_DEGREES, _MOST_DEGREES, name)
        for index, angle in enumerate(self.at_deg):
            number_within(angle, -_MOST_DEGREES, _MOST_DEGREES, f"at_deg[{index}]")
        if len(self.at_deg) > _MOST_PLACES:
            count = len(self.at_deg)
            raise ProblemError(f"at_deg has {count} driver angles; it may have up to {_MOST_PLACES}")
        for name in self.sections:
            if name not in ON_REQUEST:
                raise wrong_value("sections", name, f"some of {', '.join(ON_REQUEST)}")
        self._check_history()
        self._check_fit()

    def _check_history(self) -> None:
        if self.seconds is None or self.release_deg is not None:
            for name in ("step", "start_deg"):
                if getattr(self, name) is not None:
                    without = "without seconds" if self.seconds is None else "with release"
                    raise ProblemError(f"{name} is given {without}; it is of a history over time")
            return
        seconds = positive_number(self.seconds, "seconds")
        step = STEP if self.step is None else positive_number(self.step, "step")
        if seconds < step:
            raise ProblemError(f"seconds is {seconds:.15g}; it must be at least the step, {step:.15g}")
        if seconds / step > _MOST_ROWS:
            raise ProblemError(
                f"seconds is {seconds:.15g} and step {step:.15g}; that is more than {_MOST_ROWS} rows: "
                f"make step {seconds / _MOST_ROWS:.3g} or more"
            )

    def _check_fit(self) -> None:
        if (self.fit_from_deg is None) != (self.fit_to_deg is None):
            names = "fit_from_deg", "fit_to_deg"
            given, absent = names if self.fit_to_deg is None else names[::-1]
            raise ProblemError(f"{given} is given without {absent}; give both")
        if self.fit_from_deg is not None and self.fit_to_deg is not None:
            span = abs(self.fit_to_deg - self.fit_from_deg)
            if not 0 < span <= 360:
                raise ProblemError(
                    f"fit_from_deg and fit_to_deg are {span:.15g} deg apart; they must be up to 360 deg apart"
                )
        if whole_number(self.fit_points, 6, "fit_points") > _MOST_POINTS:
            raise ProblemError(f"fit_points is {self.fit_points}; it must be from 6 to {_MOST_POINTS}")

    def wants(self, section: str) -> bool:
        """Whether a section of `ON_REQUEST` is requested."""
        return section in self.sections or (section == "fits" and self.fit_from_deg is not None)

    @property
    def times(self) -> FloatArray | None:
        """Times of the history, shape (N,), s; None if none is requested."""
        if self.seconds is None or self.release_deg is not None:
            return None
        step = STEP if self.step is None else self.step
        return np.round(np.arange(np.floor(self.seconds / step + 1e-9) + 1) * step, 12)

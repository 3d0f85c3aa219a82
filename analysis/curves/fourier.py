"""Fourier series of a closed curve, and the errors of its first harmonics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from grashof.analysis.mechanism.even_motion import even_motion
from grashof.analysis.mechanism.mobility import full_rotation
from grashof.analysis.mechanism.position import solve_position
from grashof.analysis.numerics.peaks import greatest, own
from grashof.problems import Linkage, ProblemError
from grashof.problems.values.arrays import TURN, ComplexArray, FloatArray, IntArray
from grashof.problems.values.checks import finite_rows, whole_number

_ROUNDING = 4e-15  # share of the size
_FEWEST, _MOST = 32, 1 << 15  # steps of a turn
_SAMPLES = 1441


@dataclass(frozen=True, slots=True, eq=False)
class FourierSeries:
    """A closed curve as x + i y = sum of c_k e^(i k angle), evaluated by a call.

    Parameters
    ----------
    harmonics : ndarray of int, shape (2 M + 1,)
        -M to M. A negative one turns against the angle; k and -k together draw an ellipse.
    coefficients : ndarray of complex, shape (2 M + 1,), length
    error_max, error_rms : ndarray, shape (M + 1,), length
        Greatest and root mean square distance from the samples, or from the curve, with the harmonics up to
        0, 1, ... M.
    content : ndarray, shape (M,)
        Share of harmonics 1 to M (both senses) in the mean squared distance from the centre; NaN for a point.
    """

    harmonics: IntArray
    coefficients: ComplexArray
    error_max: FloatArray
    error_rms: FloatArray
    content: FloatArray

    def __call__(self, angle: npt.ArrayLike, up_to: int | None = None) -> FloatArray:
        """Points x, y at angles in rad, shape (..., 2), from the harmonics up to `up_to` (default all)."""
        kept = slice(None) if up_to is None else np.abs(self.harmonics) <= up_to
        turns = np.exp(1j * np.asarray(angle, dtype=np.float64)[..., None] * self.harmonics[kept])
        z = turns @ self.coefficients[kept]
        return np.stack([z.real, z.imag], axis=-1)


def fourier_series(points: npt.ArrayLike) -> FourierSeries:
    """Fourier series of a closed curve from equally spaced samples of one period.

    Parameters
    ----------
    points : array_like, shape (N, 2), length
        At the angles 0, 2 pi / N, 4 pi / N ...; the first is not repeated.

    Returns
    -------
    FourierSeries
        With M = N // 2 harmonics; it passes through all samples.

    Notes
    -----
    The discrete transform of x + i y; for even N the highest harmonic is shared between both senses. The mean
    squared error of a truncated series is the sum of the omitted |c_k|^2 (Parseval).

    Examples
    --------
    >>> angle = np.arange(8) * np.pi / 4
    >>> ellipse = fourier_series(np.stack([1 + 3 * np.cos(angle), 2 + np.sin(angle)], axis=-1))
    >>> np.abs(ellipse.coefficients[3:6]).round(12).tolist(), ellipse.error_max[:2].round(12).tolist()
    ([1.0, 2.2360679775, 2.0], [3.0, 0.0])
    """
    path = finite_rows(points, 2, "points", "a point [x, y]")
    count = len(path)
    if count < 3:
        raise ProblemError(f"there are {count} points; a closed curve needs three or more")
    top = count // 2
    harmonics = np.arange(-top, top + 1)
    coefficients = (np.fft.fft(path @ np.array([1, 1j])) / count)[harmonics % count]
    if count % 2 == 0:
        coefficients[[0, -1]] /= 2
    waves = coefficients * np.exp(1j * TURN / count * np.outer(np.arange(count), harmonics))
    left = waves[:, ::-1] + waves  # harmonic k and -k together, columns M..0..M
    tail = np.cumsum(left[:, :top], axis=1)[:, ::-1]  # all above 0, above 1, ... above M - 1
    miss = np.abs(np.column_stack([tail, np.zeros(count)]))
    return FourierSeries(
        harmonics=harmonics.astype(np.int64),
        coefficients=coefficients,
        error_max=miss.max(axis=0),
        error_rms=np.sqrt((miss**2).mean(axis=0)),
        content=_content(coefficients),
    )


def coupler_harmonics(linkage: Linkage, top: int = 5) -> FourierSeries:
    """First harmonics of the coupler curve in the driver angle, with their errors from the curve.

    Parameters
    ----------
    linkage : Linkage
        A single one whose driver turns fully.
    top : int
        Highest harmonic, from 1.

    Returns
    -------
    FourierSeries
        In theta2; its errors are from the curve itself, not from samples.

    Raises
    ------
    ProblemError
        A driver that does not turn fully.

    Notes
    -----
    c_k is the mean of P e^(-i k theta2) over equal steps of an `even_motion`, doubled until the means settle.
    Near a change point equal steps of the driver would take tens of thousands.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    >>> first = coupler_harmonics(crank_rocker, top=3)
    >>> first.error_max.round(6).tolist(), first.content.round(6).tolist()
    ([1.17829, 0.090047, 0.015903, 0.00358], [0.995662, 0.004179, 0.000151])
    """
    top = whole_number(top, 1, "top")
    _refuse_swings(linkage)
    motion, harmonics = even_motion(linkage, 0.0, TURN), np.arange(-top, top + 1)
    o2 = complex(*linkage.o2)

    def waves(share: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """P from O2, and e^(i k theta2)."""
        theta2 = motion.theta2(share)
        z = solve_position(linkage, theta2).p @ np.array([1, 1j]) - o2
        return z, np.exp(1j * theta2[..., None] * harmonics)

    count, before, change = _FEWEST, np.full(len(harmonics), np.inf), np.inf
    while change > _ROUNDING and count < _MOST:
        count *= 2
        share = np.arange(count) / count
        (z, turns), weight = waves(share), motion.rate(share) / (count * TURN)
        found = (weight * z) @ turns.conj()
        change, before = np.abs(found - before).max() / np.abs(z).max(), found

    def squares(share: FloatArray) -> FloatArray:
        """Squared distances of P from the harmonics up to 0, 1 ..., shape (top + 1, *share.shape)."""
        z, turns = waves(share)
        terms = turns * found
        pairs = terms[..., top:].copy()
        pairs[..., 1:] += terms[..., :top][..., ::-1]
        return np.moveaxis(np.abs(z[..., None] - np.cumsum(pairs, axis=-1)) ** 2, -1, 0)

    rounding = (_ROUNDING * np.abs(z).max()) ** 2
    largest, _ = greatest(lambda at: own(squares(at)), np.linspace(0, 1, _SAMPLES))
    mean = squares(share) @ weight
    found = np.where(np.abs(found) ** 2 <= rounding, 0.0, found)
    found[top] += o2
    return FourierSeries(
        harmonics=harmonics.astype(np.int64),
        coefficients=found,
        error_max=np.sqrt(np.where(largest <= rounding, 0.0, largest)),
        error_rms=np.sqrt(np.where(mean <= rounding, 0.0, mean)),
        content=_content(found, mean[0]),
    )


def coupler_fourier(linkage: Linkage, samples: int = 256) -> FourierSeries:
    """Fourier series of the coupler curve in the driver angle.

    Parameters
    ----------
    linkage : Linkage
        A single one whose driver turns fully.
    samples : int
        Equal steps of one turn.

    Returns
    -------
    FourierSeries
        In theta2.

    Raises
    ------
    ProblemError
        A driver that does not turn fully.

    Examples
    --------
    >>> from grashof.problems import FourBar
    >>> crank_rocker = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(2, 1))
    >>> series = coupler_fourier(crank_rocker)
    >>> bool(np.abs(series(0.7) - solve_position(crank_rocker, 0.7).p).max() < 1e-12)
    True
    """
    _refuse_swings(linkage)
    count = whole_number(samples, 3, "samples")
    return fourier_series(solve_position(linkage, np.arange(count) * TURN / count).p)


def _content(coefficients: ComplexArray, total: float | None = None) -> FloatArray:
    """Squared amplitudes of the harmonics from 1, both senses together, as shares of `total` or their sum."""
    power = np.abs(coefficients) ** 2
    middle = len(power) // 2
    both = power[middle + 1 :] + power[:middle][::-1]
    with np.errstate(invalid="ignore"):
        return np.asarray(both / (both.sum() if total is None else total))


def _refuse_swings(linkage: Linkage) -> None:
    if not full_rotation(linkage):
        raise ProblemError(
            "the driver does not turn fully; a Fourier series is of a closed curve over its turn"
        )

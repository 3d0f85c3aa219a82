"""What limits four-bars as function generators, as smooth functions of their shape."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.theory.function_output import SHAPE, Generators, passes

LEAST_ANGLE = float(np.radians(0.3))  # so near to a dead position no generator may come


@dataclass(frozen=True, slots=True)
class ShapeLimits:
    """Limits of a generator, zero or positive where they are kept.

    Parameters
    ----------
    span : float, rad
        Rotation of the driver from its first angle.
    caps : ndarray, shape (4, 4)
        Greatest logarithm of length j over length k of r1 to r4.
    transmission : float, rad
        Least min(mu, pi - mu).
    over_cycle : bool
        Over the whole turn, not only over the rotation.
    margin : float, optional
        The driver turns fully: r3 + r4 - r1 - r2 and abs(r1 - r2) - abs(r3 - r4) are this share of the sum
        of the lengths, or more.
    shortest : int
        +1 where r1 has to be longer than r2, -1 where it has to be shorter, 0 for either.

    Examples
    --------
    >>> limits = ShapeLimits(1.0, transmission=0.5)
    >>> values, slopes = limits.of(Generators(np.array([[0.1, 0.2, 0.3, 0.4]]), np.array([1.0])))
    >>> values.shape, slopes.shape
    ((1, 20), (1, 20, 4))
    """

    span: float
    caps: FloatArray = field(default_factory=lambda: np.full((4, 4), np.log(20.0)))
    transmission: float = 0.0
    over_cycle: bool = False
    margin: float | None = None
    shortest: int = 0

    def of(self, made: Generators) -> tuple[FloatArray, FloatArray]:
        """Values (M, K) and their derivatives by the shape (M, K, 4)."""
        parts = [self._ratios(made), self._transmission(made), *self._turning(made)]
        values, slopes = zip(*parts, strict=True)
        return np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)

    def _ratios(self, made: Generators) -> tuple[FloatArray, FloatArray]:
        logs = np.concatenate([np.zeros((len(made), 1)), made.shape[:, :3]], axis=1)
        upper, lower = np.nonzero(~np.eye(4, dtype=bool) & np.isfinite(self.caps))
        unit = np.concatenate([np.zeros((1, SHAPE)), np.eye(SHAPE)[:3]])
        slopes = np.broadcast_to(unit[lower] - unit[upper], (len(made), len(upper), SHAPE))
        return self.caps[upper, lower] - logs[:, upper] + logs[:, lower], slopes

    def _transmission(self, made: Generators) -> tuple[FloatArray, FloatArray]:
        """At both ends, and where O2A is along the ground line if the motion passes there."""
        r2, r3, r4 = np.exp(made.shape[:, :3]).T[..., None]
        first = made.shape[:, 3]
        if self.over_cycle:
            places, met = np.tile([0.0, np.pi], (len(made), 1)), np.ones((len(made), 2), dtype=bool)
            moving = np.zeros(2)
        else:
            along = np.tile([0.0, np.pi], (len(made), 1))
            places = np.concatenate([first[:, None] + [0.0, self.span], along], axis=1)
            passed = np.stack([passes(first, self.span, angle) for angle in (0.0, np.pi)], axis=1)
            met = np.concatenate([np.ones_like(passed), passed], axis=1)
            moving = np.array([1.0, 1.0, 0.0, 0.0])
        square = 1 + r2**2 - 2 * r2 * np.cos(places)
        cosine = (r3**2 + r4**2 - square) / (2 * r3 * r4)
        by_square = -1 / (2 * r3 * r4)
        slope = np.stack([
            by_square * (2 * r2**2 - 2 * r2 * np.cos(places)),
            r3 / r4 - cosine,
            r4 / r3 - cosine,
            by_square * 2 * r2 * np.sin(places) * moving,
        ], axis=-1)  # fmt: skip
        most = np.cos(max(self.transmission, LEAST_ANGLE))
        values = np.concatenate(
            [np.where(met, most - cosine, 1.0), np.where(met, most + cosine, 1.0)], axis=1
        )
        slope = np.where(met[..., None], slope, 0.0)
        return values, np.concatenate([-slope, slope], axis=1)

    def _turning(self, made: Generators) -> list[tuple[FloatArray, FloatArray]]:
        """Full rotation of the driver, in shares of the sum of the lengths."""
        lengths = made.lengths
        total = lengths.sum(axis=1, keepdims=True)
        rows = []
        if self.margin is not None:
            side = np.where(lengths[:, 1] < 1, 1.0, -1.0)
            side = np.full(len(made), float(self.shortest)) if self.shortest else side
            one = np.ones(len(made))
            rows = [[-one, -one, one, one], [side, -side, -one, one], [side, -side, one, -one]]
        elif self.shortest:
            side = np.full(len(made), float(self.shortest))
            rows = [[side, -side, 0 * side, 0 * side]]
        if not rows:
            return []
        signs = np.array(rows).transpose(2, 0, 1)  # (M, rows, 4)
        share = (signs * lengths[:, None]).sum(axis=-1) / total
        slopes = (signs - share[..., None])[..., 1:] * (lengths[:, None, 1:] / total[..., None])
        slopes = np.concatenate([slopes, np.zeros((*slopes.shape[:2], 1))], axis=-1)
        return [(share - (self.margin or 0.0), slopes)]

"""The point of a body whose four places lie on a line, and that line, enclosed."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.synth.proof.curve.curve import Curve
from grashof.synth.proof.forms.forms import Span

_ROUNDING = 1e-14  # share of the magnitude of a coefficient: some 45 units of the last place
_MOST_OFF = 1e-6  # sizes: a point, or a direction, that is known less closely bounds nothing


@dataclass(frozen=True, slots=True)
class Slide:
    """The only point that can slide on a line through four poses, in the frame of a `Curve`."""

    point: complex  # sizes, at the first pose
    off: float  # sizes, its greatest distance from there
    along: complex  # unit number: one of the two directions of the line
    turned: float  # greatest distance of the exact one from there

    @classmethod
    def of(cls, curve: Curve) -> Slide | None:
        """The slide of four poses; None where it is not known closely, or they leave a line of such points.

        With a_j = (rho_j - 1) z + d_j from the first place to another, three cross products of two of them
        vanish. Each is linear in u = (|z|^2, Re z, Im z), so that where their matrix N has an inverse there
        is one u at most: Ball's point, for poses that are finitely apart. With an approximate inverse R and
        N u = m the exact u differs by |R (m - N u)| / (1 - |I - R N|) at most.

        >>> from grashof.synth.theory.burmester import Displacements
        >>> turns = np.radians([0, 10, 30, 70])
        >>> motion = Displacements.from_poses(np.array([0, 1, 2, 5]) - np.exp(1j * turns), turns)
        >>> slide = Slide.of(Curve.of(motion, 0j))
        >>> bool(abs(slide.point) < 1e-12), bool(abs(slide.along.imag) < 1e-12), bool(slide.off < 1e-9)
        (True, True, True)
        """
        matrix, right, wide = _equations(curve)
        try:
            inverse: FloatArray = np.asarray(np.linalg.inv(matrix), dtype=np.float64)
        except np.linalg.LinAlgError:
            return None
        found = inverse @ right
        for _ in range(2):
            found = found + inverse @ (right - matrix @ found)
        size, most = _norm(inverse), 1.0 + float(np.abs(found).max())
        loose = _norm(np.asarray(np.eye(3) - inverse @ matrix)) + size * 4 * wide
        if not loose < 0.5:
            return None
        left = float(np.abs(right - matrix @ found).max())
        off = float(np.sqrt(2) * size * (left + 4 * wide * most) / (1 - loose))
        point = complex(found[1], found[2])
        places = curve.rotation * point + curve.shift
        one, other = max(combinations(places.tolist(), 2), key=lambda pair: abs(pair[1] - pair[0]))
        length, hair = abs(other - one), _ROUNDING * (1.0 + float(np.abs(places).max()))
        if not (off <= _MOST_OFF and length > 0):
            return None
        turned = 4 * (off + hair) / length + _ROUNDING
        return cls(point, off + hair, (other - one) / length, turned) if turned <= _MOST_OFF else None

    def spans(self, count: int) -> tuple[Span, Span]:
        """The point, and the direction, as forms of a symbol that they do not depend on."""
        nothing = np.zeros((1, count), dtype=np.complex128)
        point, along = (np.full(count, each, dtype=np.complex128) for each in (self.point, self.along))
        return (
            Span(point, nothing, np.full(count, self.off)),
            Span(along, nothing, np.full(count, self.turned)),
        )


def _equations(curve: Curve) -> tuple[FloatArray, FloatArray, float]:
    """Matrix and right-hand side, and a bound of the rounding error of any of their entries."""
    size = np.abs(curve.rotation[1:] - 1) + np.abs(curve.shift[1:])
    # Rows of one size; rotations and shifts are known to some units of 1.
    alpha, d = (curve.rotation[1:] - 1) / size, curve.shift[1:] / size
    wide = _ROUNDING * (2.0 + 2.0 / float(size.min()))
    rows, right = [], []
    for i, j in combinations(range(len(d)), 2):
        p, q = alpha[i].conj() * d[j], d[i].conj() * alpha[j]
        rows.append([(alpha[i].conj() * alpha[j]).imag, (p + q).imag, (q - p).real])
        right.append(-(d[i].conj() * d[j]).imag)
    return np.array(rows), np.array(right), wide


def _norm(matrix: FloatArray) -> float:
    return float(np.abs(matrix).sum(axis=1).max())

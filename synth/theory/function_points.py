"""Four-bars that generate three, four or five pairs of input and output angle exactly."""

from __future__ import annotations

import numpy as np

from grashof.problems.values.arrays import BoolArray, FloatArray, IntArray
from grashof.synth.theory.five_poses import five_pose_dyads_of_sets
from grashof.synth.theory.function_output import Generators

_TRIVIAL = 1e-6  # of the ground: a pivot so near to O2 or O4 is the ground link itself


def through_five_pairs(turned: FloatArray, output: FloatArray) -> tuple[Generators, IntArray]:
    """All four-bars through five pairs, both start angles free.

    Parameters
    ----------
    turned, output : ndarray, shape (m, 5), rad
        Rotations of driver and output from the first pair of each of m sets, zero there.

    Returns
    -------
    Generators
        Of all sets, one or three of most.
    which : ndarray of int, shape (M,)
        The set of each. They may have branch or circuit defects between their pairs.

    Notes
    -----
    Function generation is motion generation: seen from link 4, link 2 moves through known poses, and the
    unknown coupler is an RR dyad of that motion (Erdman & Sandor; families of five poses: Burmester). One
    of its roots is the ground link itself, which is left out: what remains is a cubic.

    Examples
    --------
    >>> turned = np.radians([[0, 20, 45, 70, 90]])
    >>> made, which = through_five_pairs(turned, 0.5 * turned**1.2)
    >>> from grashof.synth.theory.function_output import output_angles
    >>> theta4 = output_angles(made, turned[0])
    >>> len(made) in (1, 3)
    True
    """
    rotation = np.exp(1j * (turned - output))
    shift = 1.0 - np.exp(-1j * output)
    dyads = five_pose_dyads_of_sets(rotation, shift)
    a, b = dyads.moving, dyads.ground
    with np.errstate(invalid="ignore"):
        real = (np.abs(a) > _TRIVIAL) & (np.abs(b - 1) > _TRIVIAL) & (np.abs(b - a) > _TRIVIAL)
    which, root = np.nonzero(real)
    return Generators.of_pivots(a[which, root], b[which, root]), which


def through_four_pairs(turned: FloatArray, output: FloatArray, count: int = 2000) -> Generators:
    """Four-bars of the curve through four pairs, both start angles free.

    Parameters
    ----------
    turned, output : ndarray, shape (4,), rad
        Rotations of driver and output from the first pair, zero there.
    count : int
        Output angles that are tried at a fifth driver angle, between two of the four, where every linkage
        without a defect closes.
    """
    wide = int(np.argmax(np.diff(turned)))
    fifth = (turned[wide] + turned[wide + 1]) / 2
    tried = np.linspace(-np.pi, np.pi, count, endpoint=False) + np.pi / count
    return through_four_and(turned, output, fifth, tried)


def through_four_and(turned: FloatArray, output: FloatArray, fifth: float, tried: FloatArray) -> Generators:
    """Four-bars through four pairs, and a fifth one at each of several output angles (n,)."""
    inputs = np.broadcast_to(np.append(turned, fifth), (len(tried), 5))
    outputs = np.concatenate([np.broadcast_to(output, (len(tried), 4)), tried[:, None]], axis=1)
    return through_five_pairs(inputs, outputs)[0]


def through_three_pairs(
    turned: FloatArray, output: FloatArray, first_driver: FloatArray, first_output: FloatArray
) -> Generators:
    """Four-bars through three pairs at given start angles, or nearly through more.

    Parameters
    ----------
    turned, output : ndarray, shape (N,), rad
        Rotations of driver and output from the first pair, zero there.
    first_driver, first_output : ndarray, shape (M,), rad
        Driver and output angle at the first pair; each may come out turned by half a turn, where
        Freudenstein's equation gives a negative length.

    Returns
    -------
    Generators
        M of them; NaN where there is none. Through more than three pairs they are those of least squares of
        the output angle, to first order.

    Notes
    -----
    K1 cos psi - K2 cos phi + K3 = cos(phi - psi) with K1 = r1 / r2, K2 = r1 / r4 and
    K3 = (r1^2 + r2^2 - r3^2 + r4^2) / (2 r2 r4) (Freudenstein, *Trans. ASME* 77, 1955) is linear in K.
    Its residual over its derivative by psi is the error of the output (structural instead of design error),
    by which more than three pairs are weighted in a second step.

    Examples
    --------
    y = 1/x, Chebyshev spacing, ranges of 90 deg, from 30 and 240 deg on (Shigley & Uicker):

    >>> phi, psi = np.radians([36.03, 75, 113.97]), np.radians([251.30, 300, 326.88])
    >>> through_three_pairs(phi - phi[0], psi - psi[0], phi[:1], psi[:1]).lengths.round(2).tolist()
    [[1.0, 2.47, 0.91, 2.47]]
    """
    phi, psi = first_driver[:, None] + turned, first_output[:, None] + output
    rows = np.stack([np.cos(psi), -np.cos(phi), np.ones_like(phi)], axis=-1)
    right = np.cos(phi - psi)
    k = _solved(rows, right)
    if len(turned) > 3:
        slope = np.abs(-k[:, :1] * np.sin(psi) - np.sin(phi - psi))
        with np.errstate(invalid="ignore", divide="ignore"):
            weight = 1.0 / np.maximum(slope, 0.05 * slope.max(axis=1, keepdims=True))
        k = _solved(rows * weight[..., None], right * weight)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        r2, r4 = 1.0 / k[:, 0], 1.0 / k[:, 1]
        r3 = np.sqrt(1.0 + r2**2 + r4**2 - 2 * r2 * r4 * k[:, 2])
        middle = len(turned) // 2
        a, b = r2 * np.exp(1j * phi[:, middle]), 1.0 + r4 * np.exp(1j * psi[:, middle])
        first = first_driver + np.pi * (r2 < 0)
        shape = np.stack([np.log(np.abs(r2)), np.log(r3), np.log(np.abs(r4)), first], axis=-1)
        assembly = np.where(((b - a).conj() * (b - 1)).imag >= 0, 1.0, -1.0)
    shape[~np.isfinite(shape).all(axis=1)] = np.nan
    return Generators(shape, assembly)


def _solved(rows: FloatArray, right: FloatArray) -> FloatArray:
    """Least squares of many small systems, (M, N, 3) and (M, N) to (M, 3); NaN where they are singular."""
    normal = rows.swapaxes(1, 2) @ rows if rows.shape[1] > 3 else rows
    side = (rows.swapaxes(1, 2) @ right[..., None])[..., 0] if rows.shape[1] > 3 else right
    bad: BoolArray = ~np.isfinite(normal.sum(axis=(1, 2)))
    normal = np.where(bad[:, None, None], np.nan, normal)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        # Cramer's rule: a singular system of many must not spoil the others.
        cross = np.cross(normal[:, 1], normal[:, 2])
        determinant = (normal[:, 0] * cross).sum(axis=-1)
        columns = [cross, np.cross(normal[:, 2], normal[:, 0]), np.cross(normal[:, 0], normal[:, 1])]
        inverse = np.stack(columns, axis=-1) / determinant[:, None, None]
        found: FloatArray = (inverse @ side[..., None])[..., 0]
    return found

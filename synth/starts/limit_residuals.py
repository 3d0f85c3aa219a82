"""Limits as residuals of the batched search: how far each is overstepped, and its derivative."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Box, Requirements, Rotatability, TransmissionOver
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray, Limits
from grashof.synth.starts.closed_loop import Loop, PathTarget

LEAST_TRANSMISSION = 1e-3  # rad: keeps the motion away from dead positions


@dataclass(frozen=True, slots=True)
class Placement:
    """Linkages of a batch where they stand, with derivatives by the M unknowns.

    A = z0 + z1 e2, B = z0 + g (r2 e2 + r3 e3), O4 = z0 + g, P = A + z2 e3 with the ground g = z1 / r2.

    Parameters
    ----------
    loop : Loop
    by_theta2, by_theta3 : ndarray, shape (n, N, M)
    z : ndarray of complex, shape (n, 3), sizes
    by_z : ndarray of complex, shape (n, 3, M)
    """

    loop: Loop
    by_theta2: FloatArray
    by_theta3: FloatArray
    z: ComplexArray
    by_z: ComplexArray


@dataclass(frozen=True, slots=True)
class _Row:
    """A quantity of every linkage (n, ...), and its derivative by the unknowns (n, ..., M)."""

    value: FloatArray
    slope: FloatArray

    def outside(self, limits: Limits) -> _Row:
        """Signed amount by which the values lie above (positive) or below (negative) limits."""
        low, high = limits
        over = np.maximum(self.value - high, 0.0) - np.maximum(low - self.value, 0.0)
        return _Row(over, np.where((over != 0)[..., None], self.slope, 0.0))


@dataclass(frozen=True, slots=True)
class _ComplexRow:
    value: ComplexArray
    slope: ComplexArray

    @property
    def real(self) -> _Row:
        return _Row(self.value.real, self.slope.real)

    @property
    def imag(self) -> _Row:
        return _Row(self.value.imag, self.slope.imag)

    @property
    def length(self) -> _Row:
        size = np.maximum(np.abs(self.value), 1e-12)
        return _Row(size, ((self.value.conj() / size)[..., None] * self.slope).real)


def oversteps(target: PathTarget, at: Placement) -> tuple[FloatArray, FloatArray]:
    """How far every limit is overstepped, and the derivative by the unknowns.

    Parameters
    ----------
    target : PathTarget
    at : Placement

    Returns
    -------
    ndarray, shape (n, L)
        Lengths of links and their ratio by their logarithms, places and coupler arms in sizes, angles
        in rad, the transmission by |cos mu|.
    ndarray, shape (n, L, M)
    """
    wanted, ground = target.wanted, _ground(at)
    rows = [
        *_length_rows(wanted, at, ground),
        *_arm_rows(wanted, at, ground),
        *_place_rows(wanted, at, ground),
        *_angle_rows(wanted, at, ground),
        *_transmission_rows(target, at),
    ]
    count, unknowns = at.by_z.shape[0], at.by_z.shape[2]
    return (
        np.concatenate([row.value.reshape(count, -1) for row in rows], axis=1),
        np.concatenate([row.slope.reshape(count, -1, unknowns) for row in rows], axis=1),
    )


def _ground(at: Placement) -> _ComplexRow:
    """From O2 to O4."""
    r2, z1 = at.loop.r2, at.z[:, 1]
    by_r2 = np.zeros_like(at.by_z[:, 1])
    by_r2[:, :3] = at.loop.by_lengths[:, 0]
    value = z1 / r2
    return _ComplexRow(value, at.by_z[:, 1] / r2[:, None] - (value / r2)[:, None] * by_r2)


def _length_rows(wanted: Requirements, at: Placement, ground: _ComplexRow) -> list[_Row]:
    loop, scale = at.loop, np.maximum(np.abs(ground.value), 1e-12)
    by_scale = (ground.slope / ground.value[:, None]).real
    relative = np.stack([np.ones_like(loop.r2), loop.r2, loop.r3, loop.r4], axis=1)
    by_log = np.repeat(by_scale[:, None], 4, axis=1)
    by_log[:, 1:, :3] += loop.by_lengths / relative[:, 1:, None]
    log = np.log(relative * scale[:, None])
    low, high = np.array(wanted.link_lengths).T
    every = [
        _Row(log[:, i], by_log[:, i]).outside((np.log(max(low[i], 1e-9)), np.log(high[i]))) for i in range(4)
    ]
    rows, longest, shortest = np.arange(len(log)), np.argmax(log, axis=1), np.argmin(log, axis=1)
    ratio = _Row(log[rows, longest] - log[rows, shortest], by_log[rows, longest] - by_log[rows, shortest])
    return [*every, ratio.outside((0.0, np.log(wanted.link_ratio_max)))]


def _arm_rows(wanted: Requirements, at: Placement, ground: _ComplexRow) -> list[_Row]:
    limits, r3 = wanted.coupler_arms or (0.0, np.inf), at.loop.r3
    a_p = _ComplexRow(at.z[:, 2], at.by_z[:, 2])
    by_r3 = np.zeros_like(ground.slope)
    by_r3[:, :3] = at.loop.by_lengths[:, 1]
    a_b = _ComplexRow(
        ground.value * r3, ground.slope * r3[:, None] + ground.value[:, None] * by_r3
    )  # both arms in the coupler's frame
    b_p = _ComplexRow(a_p.value - a_b.value, a_p.slope - a_b.slope)
    return [arm.length.outside(limits) for arm in (a_p, b_p)]


def _place_rows(wanted: Requirements, at: Placement, ground: _ComplexRow) -> list[_Row]:
    """How far the pivots lie outside their boxes: O2 and O4, A and B at every target."""
    rows = []
    for name in ("o2", "o4", "a", "b"):
        box = getattr(wanted, name) or Box()
        if box == Box():
            continue
        place = _pivot(name, at, ground)
        rows += [
            part.outside(side)
            for side, part in ((box.x, place.real), (box.y, place.imag))
            if side != (-np.inf, np.inf)
        ]
    return rows


def _pivot(name: str, at: Placement, ground: _ComplexRow) -> _ComplexRow:
    loop = at.loop
    o2 = _ComplexRow(at.z[:, 0], at.by_z[:, 0])
    if name == "o2":
        return o2
    if name == "o4":
        return _ComplexRow(o2.value + ground.value, o2.slope + ground.slope)
    z1, by_z1 = at.z[:, 1:2], at.by_z[:, 1:2]
    a = _ComplexRow(
        o2.value[:, None] + z1 * loop.e2,
        o2.slope[:, None] + by_z1 * loop.e2[..., None] + (1j * z1 * loop.e2)[..., None] * at.by_theta2,
    )
    if name == "a":
        return a
    by_r3 = np.zeros_like(ground.slope)
    by_r3[:, :3] = loop.by_lengths[:, 1]
    coupler = loop.r3[:, None] * loop.e3
    by_coupler = by_r3[:, None] * loop.e3[..., None] + (1j * coupler)[..., None] * at.by_theta3
    return _ComplexRow(
        a.value + ground.value[:, None] * coupler,
        a.slope + ground.slope[:, None] * coupler[..., None] + ground.value[:, None, None] * by_coupler,
    )


def _angle_rows(wanted: Requirements, at: Placement, ground: _ComplexRow) -> list[_Row]:
    """How far ground line and driver at the first target are turned from where they are wanted."""
    rows = []
    line = _Row(np.angle(ground.value), (ground.slope / ground.value[:, None]).imag)
    driver = _Row(line.value + at.loop.theta2[:, 0], line.slope + at.by_theta2[:, 0])
    for wish, angle in ((wanted.ground_angle_deg, line), (wanted.theta2_start_deg, driver)):
        if wish is not None:
            off = np.angle(np.exp(1j * (angle.value - np.radians(wish))))
            rows.append(_Row(off, angle.slope))
    return rows


def _transmission_rows(target: PathTarget, at: Placement) -> list[_Row]:
    """How far |cos mu| exceeds what is allowed: with O2A along the ground line, and at the ends."""
    wanted, loop = target.wanted, at.loop
    least = np.radians(wanted.transmission_min_deg)
    if least <= 0 and wanted.rotatability is not Rotatability.ANY:
        return []  # a full crank has no dead position
    most = np.cos(max(least, LEAST_TRANSMISSION))
    limits = (-most, most)
    folded, stretched = passed(target, loop)
    rows = [
        _masked(_cos_mu(at, (1 - loop.r2) ** 2, -2 * (1 - loop.r2), None).outside(limits), folded),
        _masked(_cos_mu(at, (1 + loop.r2) ** 2, 2 * (1 + loop.r2), None).outside(limits), stretched),
    ]
    if wanted.transmission_over is TransmissionOver.TASK and not target.closed:
        every = range(loop.theta2.shape[1]) if target.jumbled else (0, -1)
        for k in every:
            cos, sin = np.cos(loop.theta2[:, k]), np.sin(loop.theta2[:, k])
            by_theta2 = (2 * loop.r2 * sin)[:, None] * at.by_theta2[:, k]
            diagonal2 = 1 + loop.r2**2 - 2 * loop.r2 * cos
            rows.append(_cos_mu(at, diagonal2, 2 * (loop.r2 - cos), by_theta2).outside(limits))
    return rows


def passed(target: PathTarget, loop: Loop) -> tuple[BoolArray, BoolArray]:
    """Whether the task motion passes O2A folded over the ground line, and stretched along it; (n,) each."""
    if target.wanted.transmission_over is TransmissionOver.CYCLE or target.closed:
        return np.ones(len(loop.r2), dtype=bool), np.ones(len(loop.r2), dtype=bool)
    if target.jumbled:
        return np.zeros(len(loop.r2), dtype=bool), np.zeros(len(loop.r2), dtype=bool)
    half = np.floor(np.sort(loop.theta2[:, [0, -1]], axis=1) / np.pi)
    low, high = half[:, 0] + 1, half[:, 1]  # multiples of pi in between
    count = high - low + 1
    return (count > 1) | ((count == 1) & (low % 2 == 0)), (count > 1) | ((count == 1) & (low % 2 == 1))


def _cos_mu(at: Placement, diagonal2: FloatArray, by_r2: FloatArray, by_theta2: FloatArray | None) -> _Row:
    """Law of cosines in A-B-O4: cos mu = (r3^2 + r4^2 - AO4^2) / (2 r3 r4), with r1 = 1."""
    r3, r4 = at.loop.r3, at.loop.r4
    cosine = (r3**2 + r4**2 - diagonal2) / (2 * r3 * r4)
    by_lengths = at.loop.by_lengths
    slope = np.zeros_like(at.by_theta2[:, 0])
    slope[:, :3] = (
        (1 / r4 - cosine / r3)[:, None] * by_lengths[:, 1]
        + (1 / r3 - cosine / r4)[:, None] * by_lengths[:, 2]
        - (by_r2 / (2 * r3 * r4))[:, None] * by_lengths[:, 0]
    )
    if by_theta2 is not None:
        slope -= by_theta2 / (2 * r3 * r4)[:, None]
    return _Row(cosine, slope)


def _masked(row: _Row, rows: BoolArray) -> _Row:
    return _Row(np.where(rows, row.value, 0.0), np.where(rows[:, None], row.slope, 0.0))

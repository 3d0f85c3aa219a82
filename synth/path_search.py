"""Search for linkages whose coupler curve comes near given points: many at once, in NumPy.

A linkage that is feasible by construction is described by its proportions and its driver angles at
the points; where it stands, how large it is, how it is turned and where its coupler point lies is
then linear: P_i = z0 + z1 exp(i theta2_i) + z2 exp(i theta3_i) with three complex numbers, solved
exactly (variable projection, Golub & Pereyra 1973, with Kaufman's Jacobian). Levenberg-Marquardt
improves the proportions and angles of a whole batch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from grashof.problems import Requirements, Rotatability
from grashof.problems.checks import BoolArray, ComplexArray, FloatArray, IntArray

TURN = 2 * np.pi
PULL = 0.03  # sizes of error that overstepping a limit e-fold, or by a size, counts as


@dataclass(frozen=True, slots=True)
class PathTarget:
    """What the curve has to pass.

    Parameters
    ----------
    points : ndarray of complex, shape (N,), sizes
        Without a last one that repeats the first.
    weights : ndarray, shape (N,)
        Of the squared distances.
    timing : ndarray, shape (N,), rad, or None
        Driver rotation from the first point.
    wanted : Requirements
        In the frame of the points. Its lengths, ratio and pivot boxes draw the search inwards.
    """

    points: ComplexArray
    weights: FloatArray
    timing: FloatArray | None
    wanted: Requirements

    @property
    def unknowns(self) -> int:
        """Proportions (3), and driver angles or what they are made of."""
        if self.timing is not None:
            return 4
        return 3 + len(self.points) + self.wanted.order


@dataclass(frozen=True, slots=True)
class Batch:
    """Linkages of a search.

    Parameters
    ----------
    unknowns : ndarray, shape (n, M)
        Proportions, then the first driver angle and the logarithms of the gaps between the driver
        angles and of the rest of the turn (ordered), or all driver angles.
    longer_driver : ndarray of bool, shape (n,)
        r2 > r1: among full cranks a double-crank.
    assembly : ndarray, shape (n, N)
    direction : ndarray, shape (n,)
        Sense of the driver.
    """

    unknowns: FloatArray
    longer_driver: BoolArray
    assembly: FloatArray
    direction: FloatArray

    def __len__(self) -> int:
        return len(self.unknowns)

    def __getitem__(self, index: IntArray | BoolArray) -> Batch:
        return Batch(*(getattr(self, name)[index] for name in self.__slots__))


@dataclass(frozen=True, slots=True)
class Placed:
    """Linkages of a batch where they fit the points best, in the frame of the points.

    Parameters
    ----------
    error : ndarray, shape (n,)
        Weighted sum of squared distances, sizes squared; infinite where the loop does not close.
    o2, o4 : ndarray of complex, shape (n,)
    a, b, p : ndarray of complex, shape (n, N)
    theta2 : ndarray, shape (n, N), rad
    """

    error: FloatArray
    o2: ComplexArray
    o4: ComplexArray
    a: ComplexArray
    b: ComplexArray
    p: ComplexArray
    theta2: FloatArray


def draw(target: PathTarget, count: int, rng: np.random.Generator) -> Batch:
    """Random linkages, feasible by construction; gaps between driver angles follow the points."""
    n = len(target.points)
    proportions = rng.normal(size=(count, 3)) * (1.2, 1.5, 1.0) - (0.0, 1.0, 0.0)
    rotatability = target.wanted.rotatability
    if rotatability is Rotatability.ANY:
        proportions = rng.normal(0.0, 0.7, (count, 3))
    columns = [proportions, rng.uniform(-np.pi, np.pi, (count, 1))]
    if target.timing is None and target.wanted.order:
        chord = np.abs(np.diff(target.points))
        gaps = np.log(chord / chord.sum()) * rng.uniform(0.3, 1, (count, 1)) + rng.normal(
            0, 0.4, (count, n - 1)
        )
        gaps -= np.log(np.exp(gaps).sum(axis=1, keepdims=True))
        low = 0.3 if rotatability is Rotatability.ANY else 0.03
        columns += [gaps, np.log(rng.uniform(low, 4, (count, 1)))]
    elif target.timing is None:
        columns.append(rng.uniform(-np.pi, np.pi, (count, n - 1)))
    longer = {Rotatability.CRANK_ROCKER: 0.0, Rotatability.DOUBLE_CRANK: 1.0}.get(rotatability, 0.4)
    signs = rng.choice([-1.0, 1.0], (count, 1 if target.wanted.same_branch else n))
    return Batch(
        unknowns=np.concatenate(columns, axis=1),
        longer_driver=rng.random(count) < longer,
        assembly=np.broadcast_to(signs, (count, n)),
        direction=rng.choice([-1.0, 1.0], count),
    )


def place(target: PathTarget, batch: Batch) -> Placed:
    """Where the linkages of a batch fit the points best."""
    loop = _Loop.of(target, batch)
    z, _, _, error = _project(target, loop)
    z0, z1, z2 = z.T
    ground = z1 / loop.r2
    o4 = z0 + ground
    return Placed(
        error=error,
        o2=z0,
        o4=o4,
        a=z0[:, None] + z1[:, None] * loop.e2,
        b=o4[:, None] + (ground * loop.r4)[:, None] * loop.e4,
        p=z0[:, None] + z1[:, None] * loop.e2 + z2[:, None] * loop.e3,
        theta2=loop.theta2 + np.angle(z1)[:, None],
    )


def improve(
    target: PathTarget, batch: Batch, steps: int, tolerance: float, until: int = 1
) -> tuple[Batch, FloatArray]:
    """Levenberg-Marquardt on every linkage of a batch.

    Parameters
    ----------
    target : PathTarget
    batch : Batch
    steps : int
        At most.
    tolerance : float, sizes squared
        Stop as soon as `until` linkages have no greater error.

    Returns
    -------
    batch : Batch
    error : ndarray, shape (n,), sizes squared
    """
    damping = np.full(len(batch), 1e-2)
    error, residual, jacobian = _linearised(target, batch)
    unknowns = batch.unknowns
    for _ in range(steps):
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian
        slope = (np.swapaxes(jacobian, 1, 2) @ residual[..., None])[..., 0]
        diagonal = np.einsum("sii->si", normal)
        ridge = damping[:, None] * (diagonal + 1e-12 * diagonal.max(axis=1, keepdims=True) + 1e-300)
        normal = normal + ridge[..., None] * np.eye(unknowns.shape[1])
        sound = np.isfinite(normal).all(axis=(1, 2)) & np.isfinite(slope).all(axis=1)
        normal[~sound], slope[~sound] = np.eye(unknowns.shape[1]), 0.0
        step = -np.linalg.solve(normal, slope[..., None])[..., 0]
        tried = Batch(
            unknowns + np.clip(step, -1.5, 1.5), batch.longer_driver, batch.assembly, batch.direction
        )
        new_error, new_residual, new_jacobian = _linearised(target, tried)
        better = new_error < error
        unknowns = np.where(better[:, None], tried.unknowns, unknowns)
        error = np.where(better, new_error, error)
        residual = np.where(better[:, None], new_residual, residual)
        jacobian = np.where(better[:, None, None], new_jacobian, jacobian)
        damping = np.clip(np.where(better, damping * 0.3, damping * 5), 1e-14, 1e6)
        if np.count_nonzero(error <= tolerance) >= until:
            break
    return Batch(unknowns, batch.longer_driver, batch.assembly, batch.direction), error


@dataclass(frozen=True, slots=True)
class _Loop:
    """The closed loop with r1 = 1 along the real axis, at every point; derivatives by the unknowns."""

    r2: FloatArray
    r3: FloatArray
    r4: FloatArray
    by_lengths: FloatArray  # (n, 3 lengths, 3 proportions)
    theta2: FloatArray
    e2: ComplexArray
    e3: ComplexArray
    e4: ComplexArray
    closes: BoolArray

    @classmethod
    def of(cls, target: PathTarget, batch: Batch) -> _Loop:
        if target.wanted.rotatability is Rotatability.ANY:
            lengths, by_lengths = _any_lengths(batch)
        else:
            lengths, by_lengths = _full_crank_lengths(batch)
        r2, r3, r4 = lengths
        theta2 = _driver_angles(target, batch)
        e2 = np.exp(1j * theta2)
        diagonal = 1 - r2[:, None] * e2
        s = np.abs(diagonal)
        along = (s**2 + (r3**2 - r4**2)[:, None]) / (2 * s)
        beside2 = r3[:, None] ** 2 - along**2
        closes = (beside2 > 1e-12 * r3[:, None] ** 2).all(axis=1)
        beside = batch.assembly * np.sqrt(np.where(beside2 > 0, beside2, 1.0))
        coupler = (along + 1j * beside) * diagonal / s
        output = r2[:, None] * e2 + coupler - 1
        return cls(r2, r3, r4, by_lengths, theta2, e2, coupler / r3[:, None], output / r4[:, None], closes)


def _full_crank_lengths(batch: Batch) -> tuple[tuple[FloatArray, FloatArray, FloatArray], FloatArray]:
    """r2, r3, r4 with r1 = 1: all full cranks and nothing else, from three free numbers each.

    r2 = sigmoid(a) or its inverse, r3 + r4 = 1 + r2 + exp(b), r3 - r4 = |1 - r2| tanh(c).
    """
    a, b, c = batch.unknowns[:, :3].T
    sigmoid = 1 / (1 + np.exp(-a))
    r2 = np.where(batch.longer_driver, 1 / sigmoid, sigmoid)
    dr2 = np.where(batch.longer_driver, -(1 - sigmoid) / sigmoid, sigmoid * (1 - sigmoid))
    excess, tanh, off = np.exp(b), np.tanh(c), np.abs(1 - r2)
    total, difference = 1 + r2 + excess, off * tanh
    by_a, by_c = -np.sign(1 - r2) * dr2 * tanh, off * (1 - tanh**2)
    zero = np.zeros_like(a)
    derivative = np.stack([
        np.stack([dr2, zero, zero], axis=-1),
        np.stack([dr2 + by_a, excess, by_c], axis=-1) / 2,
        np.stack([dr2 - by_a, excess, -by_c], axis=-1) / 2,
    ], axis=1)  # fmt: skip
    return (r2, (total + difference) / 2, (total - difference) / 2), derivative


def _any_lengths(batch: Batch) -> tuple[tuple[FloatArray, FloatArray, FloatArray], FloatArray]:
    lengths = np.exp(batch.unknowns[:, :3])
    r2, r3, r4 = lengths.T
    return (r2, r3, r4), lengths[:, :, None] * np.eye(3)


def _driver_angles(target: PathTarget, batch: Batch) -> FloatArray:
    """Driver angles (n, N)."""
    unknowns, sense = batch.unknowns, batch.direction[:, None]
    if target.timing is not None:
        return unknowns[:, 3:4] + sense * target.timing
    if not target.wanted.order:
        return unknowns[:, 3:]
    _, gone = shares_of_turn(unknowns[:, 4:])
    return unknowns[:, 3:4] + TURN * sense * gone


def _by_unknowns(target: PathTarget, batch: Batch) -> FloatArray:
    """Derivative of the driver angles, (n, N, M)."""
    n = len(target.points)
    slope = np.zeros((len(batch), n, batch.unknowns.shape[1]))
    if target.timing is None and not target.wanted.order:
        slope[:, :, 3:] = np.eye(n)
        return slope
    slope[:, :, 3] = 1
    if target.timing is None:
        share, gone = shares_of_turn(batch.unknowns[:, 4:])
        before = np.tril(np.ones((n, n)), -1)
        np.subtract(before, gone[:, :, None], out=slope[:, :, 4:])
        slope[:, :, 4:] *= (TURN * batch.direction[:, None] * share)[:, None]
    return slope


def shares_of_turn(log_gaps: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What gaps between N driver angles, and the rest, have of a turn; and what is gone at each; (n, N)."""
    share = np.exp(log_gaps - log_gaps.max(axis=1, keepdims=True))
    share /= share.sum(axis=1, keepdims=True)
    return share, np.concatenate([np.zeros((len(share), 1)), np.cumsum(share[:, :-1], axis=1)], axis=1)


def _project(target: PathTarget, loop: _Loop) -> tuple[ComplexArray, ComplexArray, ComplexArray, FloatArray]:
    """Best z0, z1, z2 (n, 3), the QR factors of what they span (n, N, 3) and (n, 3, 3), and the error."""
    root = np.sqrt(target.weights)
    basis = np.stack([np.ones_like(loop.e2), loop.e2, loop.e3], axis=-1) * root[:, None]
    q, r = np.linalg.qr(np.where(loop.closes[:, None, None], basis, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.swapaxes(q.conj(), 1, 2) @ (target.points * root)
        z = _back_substituted(r, share)
        residual = target.points * root - (q @ share[..., None])[..., 0]
        error = (np.abs(residual) ** 2).sum(axis=1)
    sound = loop.closes & np.isfinite(error) & np.isfinite(z).all(axis=1)
    return z, q, r, np.where(sound, error, np.inf)


def _back_substituted(r: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Solution of r x = right for upper triangular r (n, 3, 3); right (n, 3) or (n, 3, M)."""
    r = r if right.ndim == 2 else r[..., None]
    z2 = right[:, 2] / r[:, 2, 2]
    z1 = (right[:, 1] - r[:, 1, 2] * z2) / r[:, 1, 1]
    z0 = (right[:, 0] - r[:, 0, 1] * z1 - r[:, 0, 2] * z2) / r[:, 0, 0]
    return np.stack([z0, z1, z2], axis=1)


def _linearised(target: PathTarget, batch: Batch) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Cost (n,), residuals and pulls (n, 2N + L), their derivative by the unknowns (n, 2N + L, M)."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        loop = _Loop.of(target, batch)
        z, q, r, error = _project(target, loop)
        root = np.sqrt(target.weights)
        fit = z[:, :1] + z[:, 1:2] * loop.e2 + z[:, 2:] * loop.e3
        residual = (target.points - fit) * root
        by_theta2 = _by_unknowns(target, batch)
        by_theta3 = _by_theta3(loop, by_theta2)
        turned2, turned3 = 1j * z[:, 1:2] * loop.e2, 1j * z[:, 2:] * loop.e3
        slope = turned2[..., None] * by_theta2 + turned3[..., None] * by_theta3
        slope *= root[:, None]
        share = np.swapaxes(q.conj(), 1, 2) @ slope
        slope -= q @ share
        pull, by_pull = _pulls(target, loop, by_theta2[:, 0], z, -_back_substituted(r, share))
        both = np.concatenate([residual.real, residual.imag, pull], axis=1)
        jacobian = np.concatenate([-slope.real, -slope.imag, by_pull], axis=1)
        cost: FloatArray = error + (pull**2).sum(axis=1)
        return cost, both, jacobian


def _pulls(
    target: PathTarget, loop: _Loop, by_start: FloatArray, z: ComplexArray, by_z: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """How far limits are overstepped, weighted (n, L), and the derivative by the unknowns (n, L, M)."""
    wanted = target.wanted
    lengths = np.stack([np.ones_like(loop.r2), loop.r2, loop.r3, loop.r4], axis=1)
    by_lengths = np.zeros((len(z), 4, by_z.shape[2]))
    by_lengths[:, 1:, :3] = loop.by_lengths
    by_log_length = by_lengths / lengths[..., None]
    by_log_z = (by_z / z[..., None]).real
    scale, by_scale = np.abs(z[:, 1]) / loop.r2, by_log_z[:, 1] - by_log_length[:, 1]
    low, high = np.array(wanted.link_lengths).T
    log = np.log(lengths * scale[:, None])
    over = _overstep(log, np.log(np.maximum(low, 1e-9)), np.log(high))
    by_over = np.where((over != 0)[..., None], by_log_length + by_scale[:, None], 0.0)
    rows, index = np.arange(len(z)), (np.argmax(log, axis=1), np.argmin(log, axis=1))
    ratio = np.maximum(log[rows, index[0]] - log[rows, index[1]] - np.log(wanted.link_ratio_max), 0.0)
    by_ratio = by_log_length[rows, index[0]] - by_log_length[rows, index[1]]
    by_ratio = np.where((ratio > 0)[:, None], by_ratio, 0.0)
    arm = _overstep(np.log(np.abs(z[:, 2])), -np.inf, np.log((wanted.coupler_arms or (0.0, np.inf))[1]))
    by_arm = np.where((arm != 0)[:, None], by_log_z[:, 2], 0.0)
    ground = _ComplexRow(np.log(z[:, 1] / loop.r2), by_z[:, 1] / z[:, 1, None] - by_log_length[:, 1])
    driver = _Row(loop.theta2[:, 0], by_start)
    others = [*_pivot_rows(wanted, z, by_z, ground), *_angle_rows(wanted, ground, driver)]
    pulls = np.concatenate([over, np.stack([ratio, arm, *(row.value for row in others)], axis=1)], axis=1)
    slopes = np.stack([by_ratio, by_arm, *(row.slope for row in others)], axis=1)
    return PULL * pulls, PULL * np.concatenate([by_over, slopes], axis=1)


@dataclass(frozen=True, slots=True)
class _Row:
    """A quantity of every linkage (n,), and its derivative by the unknowns (n, M)."""

    value: FloatArray
    slope: FloatArray


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


def _pivot_rows(
    wanted: Requirements, z: ComplexArray, by_z: ComplexArray, log_ground: _ComplexRow
) -> list[_Row]:
    """How far the ground pivots lie outside their boxes."""
    ground = np.exp(log_ground.value)
    o2 = _ComplexRow(z[:, 0], by_z[:, 0])
    o4 = _ComplexRow(o2.value + ground, o2.slope + ground[:, None] * log_ground.slope)
    rows = []
    for box, pivot in ((wanted.o2, o2), (wanted.o4, o4)):
        for side, part in ((box.x, pivot.real), (box.y, pivot.imag)) if box else ():
            outside = _overstep(part.value, *side)
            if side != (-np.inf, np.inf):
                rows.append(_Row(outside, np.where((outside != 0)[:, None], part.slope, 0.0)))
    return rows


def _angle_rows(wanted: Requirements, log_ground: _ComplexRow, driver: _Row) -> list[_Row]:
    """How far ground line and driver (from it) at the first point are turned from where they are wanted."""
    ground = log_ground.imag
    driver = _Row(ground.value + driver.value, ground.slope + driver.slope)
    wishes = ((wanted.ground_angle_deg, ground), (wanted.theta2_start_deg, driver))
    return [
        _Row(np.angle(np.exp(1j * (angle.value - np.radians(wish)))), angle.slope)
        for wish, angle in wishes
        if wish is not None
    ]


def _overstep(value: FloatArray, low: FloatArray | float, high: FloatArray | float) -> FloatArray:
    """Signed amount by which values lie above `high` (positive) or below `low` (negative)."""
    return np.maximum(value - high, 0.0) - np.maximum(low - value, 0.0)


def _by_theta3(loop: _Loop, by_theta2: FloatArray) -> FloatArray:
    """Derivative of theta3 by the unknowns, (n, N, M), from the loop equation projected on O4B."""
    driver, coupler = loop.e2 * loop.e4.conj(), loop.e3 * loop.e4.conj()
    below = loop.r3[:, None] * coupler.imag
    slope = (-(loop.r2[:, None] * driver.imag) / below)[..., None] * by_theta2
    by_r2, by_r3, by_r4 = (loop.by_lengths[:, None, i] for i in range(3))
    lengths = driver.real[..., None] * by_r2 + coupler.real[..., None] * by_r3 - by_r4
    slope[:, :, :3] += lengths / below[..., None]
    return slope

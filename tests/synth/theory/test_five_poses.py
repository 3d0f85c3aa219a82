"""Dyads of five poses: all that a second, unrelated method finds, and no others; each exact."""

from dataclasses import dataclass

import numpy as np
import pytest
from circles import radii
from hypothesis import given, settings
from hypothesis import strategies as st

from grashof.analysis.judge.planted import planted_motion
from grashof.problems import FourBar, MotionTask
from grashof.problems.values.arrays import BoolArray, ComplexArray, FloatArray
from grashof.synth.theory.burmester import Displacements, Dyads
from grashof.synth.theory.five_poses import five_pose_dyads, five_pose_dyads_of_sets, five_pose_guides

SETS = 1000


@dataclass(frozen=True)
class Poses:
    """Many sets of five poses; independent of `Displacements`."""

    positions: ComplexArray
    angles: FloatArray

    @property
    def displacements(self) -> tuple[ComplexArray, ComplexArray]:
        rotation = np.exp(1j * (self.angles - self.angles[:, :1]))
        return rotation, self.positions - rotation * self.positions[:, :1]

    def radii(self, dyads: Dyads) -> FloatArray:
        """Distances (m, 4, 5) of the moving pivots from their centres."""
        return radii(self.positions[:, None], self.angles[:, None], dyads)

    @property
    def size(self) -> FloatArray:
        return np.asarray(np.abs(self.positions[:, :, None] - self.positions[:, None]).max(axis=(1, 2)))


def random_poses(seed: int, sets: int = SETS, turn: float = np.pi) -> Poses:
    rng = np.random.default_rng(seed)
    return Poses(rng.normal(size=(sets, 5, 2)) @ [1, 1j], rng.uniform(-turn, turn, (sets, 5)))


def by_two_parameters(poses: Poses, rng: np.random.Generator) -> tuple[ComplexArray, ComplexArray, BoolArray]:
    """Circle and centre points (m, 9) as eigenvalues of a two-parameter problem, and which are right.

    The rows (z_j - z_1, (|z_j|^2 - |z_1|^2) / 2) are linear in x, y of the moving point z, and the
    columns dependent: M(x, y) (c, -1) = 0. Two random mixtures of the four rows ask for two square
    matrices singular at once, which Atkinson's operator determinants solve; of nine solutions those
    with one null vector for both are the dyads. Coordinates are mixed at random so that the circular
    points are finite too.
    """
    rotation, shift = (part[:, 1:] for part in poses.displacements)
    a = np.stack([shift.real, shift.imag, 0.5 * np.abs(shift) ** 2], axis=-1)
    b, c = (
        np.stack([((rotation - 1) * unit).real, ((rotation - 1) * unit).imag, half], axis=-1)
        for unit, half in ((1, (shift.conj() * rotation).real), (1j, -(shift.conj() * rotation).imag))
    )
    mix, rows = rng.normal(size=(3, 3)), rng.normal(size=(2, 3, 4))
    a, b, c = (mix[0, k] * a + mix[1, k] * b + mix[2, k] * c for k in range(3))
    (a1, b1, c1), (a2, b2, c2) = ((row @ a, row @ b, row @ c) for row in rows)

    def product(left: FloatArray, right: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("mij,mkl->mikjl", left, right).reshape(-1, 9, 9))

    delta0 = product(b1, c2) - product(c1, b2)
    first = np.linalg.solve(delta0, product(c1, a2) - product(a1, c2))
    second = np.linalg.solve(delta0, product(a1, b2) - product(b1, a2))
    xi, vectors = np.linalg.eig(first)
    eta = (np.linalg.pinv(vectors) @ second @ vectors).diagonal(axis1=1, axis2=2)
    coordinates = np.stack([np.ones_like(xi), xi, eta], axis=-1) @ mix.T
    squares = vectors.transpose(0, 2, 1).reshape(-1, 9, 3, 3)
    skew = np.abs(squares - squares.transpose(0, 1, 3, 2)).max(axis=(2, 3))
    with np.errstate(all="ignore"):
        x, y = (coordinates[..., k] / coordinates[..., 0] for k in (1, 2))
        centre = -squares[..., 2, :2] / squares[..., 2, 2:]
        imaginary = np.abs(x.imag) + np.abs(y.imag) + np.abs(centre.imag).sum(axis=-1)
        moving, ground = x.real + 1j * y.real, centre[..., 0].real + 1j * centre[..., 1].real
        real = imaginary < 1e-5 * (1 + np.abs(moving) + np.abs(ground))
    return moving, ground, real & (skew < 1e-6)


def missing(found: Dyads, moving: ComplexArray, ground: ComplexArray, wanted: BoolArray) -> FloatArray:
    """Share of the coordinates by which the nearest dyad found is off, for each that is wanted."""
    scale = 1 + np.abs(moving) + np.abs(ground)
    gap = np.abs(found.moving[:, None] - moving[..., None])
    gap += np.abs(found.ground[:, None] - ground[..., None])
    nearest = np.where(np.isnan(gap), np.inf, gap).min(axis=-1)
    return np.asarray(nearest[wanted] / scale[wanted])  # the others may be infinite


@pytest.mark.parametrize(("seed", "turn"), [(1, np.pi), (2, 0.4)])
def test_the_real_dyads_are_those_of_a_second_method(seed: int, turn: float) -> None:
    poses = random_poses(seed, turn=turn)
    found = five_pose_dyads_of_sets(*poses.displacements)
    moving, ground, real = by_two_parameters(poses, np.random.default_rng(7))
    counts = np.isfinite(found.moving).sum(axis=1)
    np.testing.assert_array_equal(counts, real.sum(axis=1))
    assert missing(found, moving, ground, real).max() < 1e-6
    assert set(counts) == {0, 2, 4}


@pytest.mark.parametrize("turn", [np.pi, 0.4, 0.01])
def test_the_dyads_are_exact(turn: float) -> None:
    poses = random_poses(3, turn=turn)
    radii = poses.radii(five_pose_dyads_of_sets(*poses.displacements))
    error = (radii.max(axis=-1) - radii.min(axis=-1)) / poses.size[:, None]
    assert np.isfinite(error).sum() > SETS
    assert np.nanmax(error) < 1e-9
    assert np.nanmedian(error) < 1e-12


def test_how_many_dyads_random_poses_have() -> None:
    """Against a published count of 3 000 sets of this distribution, within its scatter."""
    poses = random_poses(4, sets=20_000)
    counts = np.isfinite(five_pose_dyads_of_sets(*poses.displacements).moving).sum(axis=1)
    share = np.bincount(counts, minlength=5) / len(counts)
    np.testing.assert_array_equal(share[[1, 3]], 0)
    np.testing.assert_allclose(share[[0, 2, 4]], np.array([305, 2110, 585]) / 3000, atol=0.03)


def test_five_of_the_poses_of_hsieh() -> None:
    """Hsieh 2017; both dyads from an earlier, separate computation, the moving one in the body's frame."""
    poses = np.array(
        [[18.8, 12.1, -0.9], [6.3, 19.8, 0.7], [-2.7, 10.3, 2.8], [0.2, 1.7, -2.0], [7.8, -4.9, -2.1]]
    )
    positions = poses[:, 0] + 1j * poses[:, 1]
    ground = np.array([4.616941194068626 + 12.27973369323716j, 1.211447231098604 + 11.336575588440953j])
    own = np.array([-11.603831497586635 - 6.021388940909035j, -5.376204106028545 - 9.123631865688198j])
    dyads = five_pose_dyads(Displacements.from_poses(positions, poses[:, 2]))
    assert len(dyads) == 2
    order = np.argsort(-dyads.ground.real)
    np.testing.assert_allclose(dyads.ground[order], ground, atol=1e-9, rtol=0)
    np.testing.assert_allclose(dyads.moving[order], positions[0] + own * np.exp(-0.9j), atol=1e-9, rtol=0)
    np.testing.assert_allclose(
        np.abs(dyads.moving - dyads.ground)[order], [5.636860509794554, 7.133954897924498], atol=1e-9
    )


def planted(seed: int) -> tuple[MotionTask, FourBar]:
    return planted_motion(np.random.default_rng(seed), poses=5)


@pytest.mark.slow
def test_the_dyads_of_every_planted_four_bar_are_found() -> None:
    tasks, linkages = zip(*(planted(seed) for seed in range(SETS)), strict=True)
    poses = Poses(
        np.array([task.positions @ [1, 1j] for task in tasks]), np.array([task.angles for task in tasks])
    )
    along = np.exp(1j * (poses.angles[:, 0] - [float(one.body_angle) for one in linkages]))
    a = poses.positions[:, 0] - along * [complex(*one.coupler_point) for one in linkages]
    b = a + along * [float(one.r3) for one in linkages]
    ground = np.array([[complex(*one.o2), complex(*one.o4)] for one in linkages])
    found = five_pose_dyads_of_sets(*poses.displacements)
    off = missing(found, np.stack([a, b], axis=1), ground, np.ones((SETS, 2), np.bool_))
    assert off.max() < 1e-8


def one_set(seed: int) -> tuple[ComplexArray, FloatArray]:
    poses = random_poses(seed, sets=1)
    return poses.positions[0], poses.angles[0]


def in_order(dyads: Dyads) -> ComplexArray:
    """Shape (n, 2), moving and ground, by the ground pivot."""
    pairs: ComplexArray = np.stack([dyads.moving, dyads.ground], axis=1)
    return pairs[np.argsort(dyads.ground.real)]


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.permutations(range(5)), st.floats(0.01, 100), st.floats(-3, 3))
def test_neither_frame_nor_order_matters(seed: int, order: list[int], scale: float, turn: float) -> None:
    positions, angles = one_set(seed)
    motion = Displacements.from_poses(positions, angles)
    dyads = five_pose_dyads(motion)
    factor, shift = scale * np.exp(1j * turn), 30 * scale * np.exp(2j * turn)
    other = Displacements.from_poses((factor * positions + shift)[order], (angles + turn)[order])
    again = five_pose_dyads(other)
    expected = Dyads(factor * motion.apply(dyads.moving)[:, order[0]] + shift, factor * dyads.ground + shift)
    rotated = Dyads(again.moving / factor, again.ground / factor)
    far = 1 + np.abs(dyads.moving).max(initial=0) + np.abs(dyads.ground).max(initial=0)
    np.testing.assert_allclose(
        in_order(rotated),
        in_order(Dyads(expected.moving / factor, expected.ground / factor)),
        atol=1e-8 * far,
    )


@pytest.mark.parametrize("seed", range(8))
def test_seen_from_the_body_the_pivots_change_places(seed: int) -> None:
    motion = Displacements.from_poses(*one_set(seed))
    dyads, turned = five_pose_dyads(motion), five_pose_dyads(motion.inverse())
    np.testing.assert_allclose(in_order(Dyads(turned.ground, turned.moving)), in_order(dyads), rtol=1e-8)


def test_where_two_dyads_merge_and_vanish() -> None:
    """Along a path of motions from more dyads to fewer, halved down to the double root itself."""
    start, end = random_poses(11, sets=400), random_poses(12, sets=400)

    def between(share: FloatArray) -> tuple[Dyads, FloatArray]:
        part = share[:, None]
        poses = Poses(
            start.positions + part * (end.positions - start.positions),
            start.angles + part * (end.angles - start.angles),
        )
        dyads = five_pose_dyads_of_sets(*poses.displacements)
        radii = poses.radii(dyads)
        error = np.nan_to_num((radii.max(axis=-1) - radii.min(axis=-1)) / (1 + np.abs(dyads.ground)))
        assert error.max() < 1e-10
        return dyads, np.isfinite(dyads.moving).sum(axis=1)

    low, high = np.zeros(400), np.ones(400)
    more, fewer = between(low)[1], between(high)[1]
    change = more > fewer
    assert change.sum() > 50
    for _ in range(52):
        middle = 0.5 * (low + high)
        count = between(middle)[1]
        low, high = np.where(count >= more, middle, low), np.where(count >= more, high, middle)
    at_low, at_high = between(low)[1][change], between(high)[1][change]
    assert (at_low >= more[change]).all()
    # A double root is there once; next to it there are none, or two.
    assert (np.abs(at_low - at_high) <= 2).all()
    assert (at_low - at_high == 1).mean() > 0.9


def crank_and_guide(offset: float) -> tuple[Displacements, Dyads]:
    """A slider-crank: A on the unit circle, B on the line y = `offset`, 3 from A; body at A along AB."""
    a = np.exp(1j * np.array([0.3, 1.1, 2.0, 3.5, 5.0]))
    lean = np.arcsin((offset - a.imag) / 3)
    b = a[0] + 3 * np.exp(1j * lean[0])
    return Displacements.from_poses(a, lean), Dyads(np.array([a[0], b]), np.array([0, np.nan]))


@pytest.mark.parametrize("offset", [0.0, 0.4, -1.2])
@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_guide_in_the_ground_is_distinguished(offset: float, turn: float) -> None:
    motion, known = crank_and_guide(offset)
    motion = Displacements(motion.rotation, motion.shift * np.exp(1j * turn))
    moving = known.moving * np.exp(1j * turn)
    guides, dyads = five_pose_guides(motion), five_pose_dyads(motion)
    assert guides.in_body.tolist() == [False]
    assert guides.pivot[0] == pytest.approx(moving[1], abs=1e-9)
    assert abs((guides.along[0] * np.exp(-1j * turn)).imag) < 1e-9
    assert np.abs(dyads.moving - moving[0]).min() < 1e-9
    assert np.abs(dyads.moving - moving[1]).min() > 1e-2
    assert len(dyads) in (1, 3)


def test_a_guide_in_the_body_is_distinguished() -> None:
    motion, known = crank_and_guide(0.4)
    back = motion.inverse()
    guides = five_pose_guides(back)
    assert guides.in_body.tolist() == [True]
    assert guides.pivot[0] == pytest.approx(known.moving[1], abs=1e-9)
    # The body's line through the joint passes through it at all poses.
    line = back.apply(guides.pivot + np.array([0, 7]) * guides.along[0])
    ahead = (line[1] - line[0]) / 7
    assert np.abs(((guides.pivot - line[0]) * ahead.conj()).imag).max() < 1e-9


def test_a_very_flat_arc_is_a_guide_beyond_reach() -> None:
    """Two dyads, one of 1e4 and one of 3: within a reach of 1e3 only the latter is an arm."""
    a, centre = np.exp(1j * np.array([0.3, 1.1, 2.0, 3.5, 5.0])), 3 - 1e4j
    to_centre = centre - a
    foot = (np.abs(to_centre) ** 2 + 9 - 1e8) / (2 * np.abs(to_centre))
    b = a + to_centre / np.abs(to_centre) * (foot + 1j * np.sqrt(9 - foot**2))
    motion = Displacements.from_poses(a, np.angle(b - a))
    dyads, near = five_pose_dyads(motion), five_pose_dyads(motion, reach=1e3)
    assert len(five_pose_guides(motion)) == 0
    assert np.abs(dyads.ground - centre).min() < 1e-6 * 1e4
    assert len(near) == len(dyads) - 1
    guides = five_pose_guides(motion, reach=1e3)
    assert guides.pivot == pytest.approx(b[:1], abs=1e-8)
    assert abs(guides.along[0].imag) < 1e-3


P, T = one_set(3)
CIRCLE = np.exp(1j * np.arange(5.0))
FAMILIES = {
    "translation": (P, np.ones(5)),
    "translation but for rounding": (P, 1 + 1e-14 * T),
    "translation along a circle": (CIRCLE, np.zeros(5)),
    "rotation": (20 + 30j + (1 + 2j) * np.exp(1j * T), T),
    "rotation about the origin": (np.zeros(5), T),
    "no motion": (np.zeros(5), np.zeros(5)),
    "second and fourth equal": (P[[0, 1, 2, 1, 4]], T[[0, 1, 2, 1, 4]] + [0, 0, 0, 2 * np.pi, 0]),
    "first and last equal": (P[[0, 1, 2, 3, 0]], T[[0, 1, 2, 3, 0]]),
    "four translations along a circle": (np.append(CIRCLE[:4], 2 + 1j), np.array([0, 0, 0, 0, 1.0])),
    "not finite": (P * np.nan, T),
}


@pytest.mark.parametrize("kind", FAMILIES)
def test_families_have_no_dyads_of_their_own(kind: str) -> None:
    positions, angles = FAMILIES[kind]
    motion = Displacements.from_poses(np.asarray(positions, np.complex128), angles)
    assert len(five_pose_dyads(motion)) == 0
    assert len(five_pose_guides(motion)) == 0


def test_a_family_does_not_disturb_its_neighbours() -> None:
    poses = random_poses(5, sets=7)
    alone = five_pose_dyads_of_sets(*poses.displacements)
    for kind, (positions, angles) in FAMILIES.items():
        poses.positions[3], poses.angles[3] = positions, angles
        among = five_pose_dyads_of_sets(*poses.displacements)
        assert np.isnan(among.moving[3]).all(), kind
        others = [0, 1, 2, 4, 5, 6]
        np.testing.assert_allclose(among.moving[others], alone.moving[others], rtol=1e-9)


@pytest.mark.parametrize("equal", [[0, 1], [2, 4], [0, 1, 2], [1, 3, 4]])
def test_equal_angles_among_others_are_nothing_special(equal: list[int]) -> None:
    poses = random_poses(6)
    poses.angles[:, equal] = poses.angles[:, equal[:1]]
    dyads = five_pose_dyads_of_sets(*poses.displacements)
    radii = poses.radii(dyads)
    error = (radii.max(axis=-1) - radii.min(axis=-1)) / (1 + np.abs(dyads.ground))
    assert np.nanmax(error) < 1e-11
    moving, ground, real = by_two_parameters(poses, np.random.default_rng(8))
    assert real.sum() > SETS
    assert missing(dyads, moving, ground, real).max() < 1e-5


@pytest.mark.parametrize("off", [1e-2, 1e-4, 1e-6])
def test_dyads_of_nearly_a_rotation(off: float) -> None:
    """Displacements grow with `off` about the pole, and so do the dyads."""
    positions, angles = one_set(8)
    expected = in_order(five_pose_dyads(Displacements.from_poses(positions, angles)))
    pole = 0.4 - 0.3j
    near = Displacements.from_poses(pole + np.exp(1j * angles) + off * positions, angles)
    # About the pole z -> r z + off s: similar to the first.
    found = in_order(five_pose_dyads(near))
    np.testing.assert_allclose((found - pole) / off, expected, atol=1e-12 / off)


def test_other_numbers_of_poses_are_refused_and_no_sets_have_no_dyads() -> None:
    for poses in (3, 4, 6):
        motion = Displacements(np.ones(poses, np.complex128), np.zeros(poses, np.complex128))
        with pytest.raises(ValueError, match="five poses"):
            five_pose_dyads(motion)
    assert five_pose_dyads_of_sets(*np.empty((2, 0, 5), np.complex128)).moving.shape == (0, 4)

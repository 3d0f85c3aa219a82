import numpy as np

from grashof.synth.theory.functions.four_bar import FourBars


def test_three_pairs_of_the_textbook() -> None:
    """y = 1/x, Chebyshev spacing, from 30 and 240 deg (Shigley & Uicker; families: K and lengths)."""
    phi, psi = np.radians([36.03, 75, 113.97]), np.radians([251.30, 300, 326.88])
    made = FourBars.at_starts(phi - phi[0], psi - psi[0], phi[:1], psi[:1])
    assert np.abs(made.lengths[0] - [1, 2.47499, 0.91205, 2.47433]).max() < 1e-3
    theta4 = made.outputs(phi - phi[0])[0]
    assert np.abs(np.diff(theta4) - np.diff(psi)).max() < 1e-9
    # A negative r4 is half a turn more.
    assert abs(np.angle(np.exp(1j * (theta4[0] - psi[0] - np.pi)))) < 1e-9


def test_a_parallelogram_has_no_three_pairs() -> None:
    turned = np.array([0.0, 0.5, 1.0])
    made = FourBars.at_starts(turned, turned, np.array([0.3]), np.array([0.3]))
    assert not np.isfinite(made.shape).all() or len(made) == 1


def test_the_loop_closes_where_the_transmission_is_that_of_one() -> None:
    rng = np.random.default_rng(3)
    made = FourBars(rng.uniform(-1, 1, (500, 4)), np.ones(500))
    closed = np.isfinite(made.outputs(np.linspace(0.0, 2.0, 1001))).all(axis=1)
    surely = np.abs(made.worst_cosine(2.0) - 1) > 1e-3
    assert surely.sum() > 400
    assert ((made.worst_cosine(2.0) < 1) == closed)[surely].all()

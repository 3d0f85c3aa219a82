"""Mass properties: published figures, integrals over the shapes, and Steiner's theorem."""

import pickle
from typing import Any

import numpy as np
import pytest

from grashof.analysis import (
    Body,
    Masses,
    given_masses,
    solve_kinematics,
    system_centre,
    triangular_plate,
    uniform_bar,
    uniform_bars,
)
from grashof.problems import FourBar, ProblemError


def test_masses_of_the_reference_figures(golden: dict[str, Any], golden_linkages: dict[str, FourBar]) -> None:
    figures = golden["pumpjack_report_geometry"]["mass_com"]
    linkage = golden_linkages["pumpjack"]
    bars = uniform_bars(linkage, (0.04 * 7800, 0.04 * 7800, 0.04 * 7850))
    assert bars.crank.mass == pytest.approx(float(figures["m_crank"]), rel=1e-12)
    assert bars.coupler.mass == pytest.approx(float(figures["m_coupler"]), rel=1e-12)
    assert bars.output.mass == pytest.approx(float(figures["m_rocker(3.048762 m)"]), rel=1e-12)
    assert bars.total == pytest.approx(float(figures["total_rocker_only"]), rel=1e-12)
    inertias = golden["pumpjack_report_geometry"]["inverse_dynamics"]["inertias"]
    np.testing.assert_allclose([bars.of(link).inertia for link in (2, 3, 4)], np.array(inertias, float))
    state = solve_kinematics(linkage, np.pi / 2)
    centre = np.array(figures["COM_rocker_only@theta2=90deg,sigma=+1"], dtype=np.float64)
    np.testing.assert_allclose(system_centre(bars, state).position, centre, rtol=1e-12)
    # The full beam reaches from B through O4 over A + C.
    length = float(figures["beam_full_length_A+C"])
    beam = uniform_bar(length, 0.04 * 7850)
    beam = Body(beam.mass, beam.inertia, (linkage.r4 - length / 2, 0))
    full = Masses(bars.crank, bars.coupler, beam)
    assert full.total == pytest.approx(float(figures["total_beam_full"]), rel=1e-12)
    centre = np.array(figures["COM_beam_full@theta2=90deg,sigma=+1"], dtype=np.float64)
    np.testing.assert_allclose(system_centre(full, state).position, centre, rtol=1e-12)


def test_triangles_and_bars_by_integration() -> None:
    rng = np.random.default_rng(2)
    base, apex = 2.3, np.array([0.7, -1.9])
    share = rng.random((400000, 2))
    flip = share.sum(axis=1) > 1
    share[flip] = 1 - share[flip]
    points = share[:, :1] * np.array([base, 0]) + share[:, 1:] * apex
    plate = triangular_plate(base, apex, 3.0)
    assert plate.mass == pytest.approx(3 * base * 1.9 / 2)
    np.testing.assert_allclose(points.mean(axis=0), plate.centre, atol=5e-3)
    assert plate.inertia == pytest.approx(plate.mass * points.var(axis=0).sum(), rel=5e-3)
    wide = uniform_bar(2.0, 3.0, width=0.5)
    points = rng.random((400000, 2)) * [2.0, 0.5]
    assert wide.inertia == pytest.approx(6.0 * points.var(axis=0).sum(), rel=5e-3)


def test_bodies_add_by_steiner() -> None:
    full, half = uniform_bar(2.0, 3.0), uniform_bar(1.0, 3.0)
    both = half + Body(half.mass, half.inertia, half.centre + np.array([1, 0]))
    assert both.mass == pytest.approx(full.mass)
    assert both.inertia == pytest.approx(full.inertia)
    np.testing.assert_allclose(both.centre, full.centre)
    nothing = Body(0.0) + Body(0.0)
    assert nothing.mass == 0


def test_payload_and_given_masses() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3, coupler_point=(1, 2))
    bars = uniform_bars(linkage, 2.0, payload=5.0)
    assert bars.coupler.mass == 8 + 5
    np.testing.assert_allclose(bars.coupler.centre * 13, [8 * 2 + 5 * 1, 5 * 2])
    known = given_masses(linkage, (1, 2, 3), (0.1, 0.2, 0.3))
    np.testing.assert_array_equal(known.output.centre, [1.5, 0])
    placed = given_masses(linkage, (1, 2, 3), (0.1, 0.2, 0.3), [(0, 0), (1, 1), (2, 0)])
    np.testing.assert_array_equal(placed.coupler.centre, [1, 1])


def test_bad_input_is_reported() -> None:
    linkage = FourBar(o2=(0, 0), o4=(4, 0), r2=1, r3=4, r4=3)
    still = solve_kinematics(linkage, 0.0)
    for act, message in (
        (lambda: Body(-1), "mass is -1"),
        (lambda: Body(1, float("nan")), "inertia is nan"),
        (lambda: Body(1, 1, (1, 2, 3)), "centre has shape"),
        (lambda: given_masses(linkage, (1, 2), (1, 2, 3)), "masses has 2 entries"),
        (lambda: system_centre(given_masses(linkage, (0, 0, 0), (0, 0, 0)), still), "no mass"),
    ):
        with pytest.raises(ProblemError, match=message):
            act()


def test_bodies_keep_their_parts() -> None:
    bar, weight, boss = uniform_bar(2.0, 3.0), Body(5.0, 0.0, (-1.0, 0.0)), Body(1.0, 0.2, (2.0, 0.0))
    assert bar.pieces == (bar,)
    full = (bar + weight) + (boss + weight)
    assert full.pieces == (bar, weight, boss, weight)
    assert sum(float(piece.mass) for piece in full.pieces) == float(full.mass)
    masses = Masses(full, bar, bar).with_payload(4.0, (1.0, 1.0))
    assert masses.coupler.pieces[0] is bar
    assert [float(piece.mass) for piece in masses.coupler.pieces] == [6.0, 4.0]
    copied = pickle.loads(pickle.dumps(full))
    assert [float(piece.mass) for piece in copied.pieces] == [6.0, 5.0, 1.0, 5.0]
    assert not copied.pieces[0].centre.flags.writeable

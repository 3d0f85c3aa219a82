"""Loads: what springs, joints and forces do to the links."""

import numpy as np
import pytest

from grashof import analysis
from grashof.analysis import AppliedForce, AppliedMoment, Friction, Loads, Spring, solve_kinematics
from grashof.analysis.forces.joints import joint_motion, joints_of
from grashof.analysis.forces.loads import (
    known_joint_moments,
    placed_loads,
    spring_ends,
    spring_pull,
    wrenches,
)
from grashof.problems import FourBar, ProblemError

CRANK_ROCKER = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3)
STATE = solve_kinematics(CRANK_ROCKER, np.array([0.3, 2.0]), 2.0)


def test_a_spring_pulls_by_its_stretch_and_its_rate() -> None:
    # From the ground to A along the crank, which keeps its length: nothing to damp.
    along = Spring(1, (1, 2), 2, (1, 0), 10.0, 0.4, damping=3.0)
    pull = spring_pull(along, *spring_ends(STATE, along))
    arm = STATE.a.position - CRANK_ROCKER.o2
    np.testing.assert_allclose(pull, 10 * 0.6 * arm, rtol=1e-12)
    # From a point far to the right, where A's velocity in x is the rate of length.
    far = Spring(1, (1e6, 2), 2, (1, 0), 0.0, 0.0, damping=3.0)
    pull = spring_pull(far, *spring_ends(STATE, far))
    np.testing.assert_allclose(pull[:, 0], 3 * STATE.a.velocity[:, 0], atol=1e-4)
    both = wrenches(STATE, Loads(springs=(along,)))
    np.testing.assert_allclose(both[1].force, -both[2].force)
    np.testing.assert_allclose(both[2].moment, 0, atol=1e-12)


def test_a_spring_of_no_length_pulls_nowhere() -> None:
    point = Spring(2, (1, 0), 3, (0, 0), 10.0, 0.4)
    np.testing.assert_array_equal(spring_pull(point, *spring_ends(STATE, point)), 0)


def test_joint_motions_are_of_the_second_link_against_the_first() -> None:
    rates = [joint_motion(STATE, joint)[1] for joint in joints_of(STATE.linkage)]
    expected = [STATE.omega2, STATE.omega3 - STATE.omega2, STATE.omega4 - STATE.omega3, STATE.omega4]
    np.testing.assert_array_equal(rates, expected)
    moments = known_joint_moments(STATE, Loads(friction=Friction(viscous=0.5, coulomb=(1, 2, 3, 4))))
    for joint, rate in enumerate(rates):
        np.testing.assert_allclose(moments[joint], -0.5 * rate - (joint + 1) * np.sign(rate))


def test_torsion_springs_are_wound_the_short_way() -> None:
    spring = analysis.TorsionSpring(analysis.Joint.O4, 2.0, 3.0)
    np.testing.assert_allclose(spring.wound(np.array([3.1, -3.1, 2.9])), [0.1, 2 * np.pi - 6.1, -0.1])
    moments = known_joint_moments(STATE, Loads(torsion_springs=(spring,)))
    np.testing.assert_allclose(moments[3], -2 * spring.wound(STATE.theta4))


def test_forces_turn_with_their_link_or_do_not() -> None:
    fixed, turning = (AppliedForce(2, (0.5, 0), (0.0, 6.0), turning) for turning in (False, True))
    felt = wrenches(STATE, Loads(forces=(turning,), moments=(AppliedMoment(4, lambda s: s.theta2),)))
    np.testing.assert_allclose(felt[2].moment, 3.0)
    np.testing.assert_allclose(felt[4].moment, STATE.theta2)
    felt = wrenches(STATE, Loads(forces=(fixed,)))
    np.testing.assert_allclose(felt[2].moment, 3.0 * np.cos(STATE.theta2))


def test_bad_input_is_reported() -> None:
    with pytest.raises(ProblemError, match="coulomb friction"):
        Friction(coulomb=(1, 2, 3)).each("coulomb")
    with pytest.raises(ProblemError, match="gravity"):
        Loads(gravity=(0, np.nan)).gravity_vector()


def test_moments_enter_by_the_shafts_and_at_p_unless_they_say_where() -> None:
    linkage = FourBar(o2=(1, 2), o4=(5, 2), r2=1, r3=4, r4=3, coupler_point=(1.5, 0.5))
    state = solve_kinematics(linkage, 0.3)
    moments = (*(AppliedMoment(link, 1.0) for link in (2, 3, 4)), AppliedMoment(4, 1.0, at=(2.0, 0.1)))
    places = [np.asarray(load.at).tolist() for load in placed_loads(state, Loads(moments=moments))]
    assert places == [[0, 0], [1.5, 0.5], [0, 0], [2.0, 0.1]]

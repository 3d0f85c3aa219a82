"""Work of friction in a turn, and the efficiency, compared with sums over dense samples."""

import numpy as np
import pytest

from grashof.analysis import inverse_dynamics, stated_loads, stated_masses
from grashof.problems import FourBar, LinkageSpec
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.problems.values.dynamics.load_specs import FrictionSpec, LoadSpec
from grashof.problems.values.dynamics.motor import MotorSpec
from grashof.sections.drive import energy_section
from grashof.study.study import Asked, LinkageStudy

CRANK_ROCKER = FourBar((0, 0), (4, 0), 1, 4, 3, (1, 1))


def facts(dynamics: DynamicsSpec, linkage: FourBar = CRANK_ROCKER) -> dict[str, float]:
    study = LinkageStudy.of(LinkageSpec(linkage, "one", length_unit="m", dynamics=dynamics), Asked())
    section = energy_section(study)
    assert section is not None
    return {fact.key: float(fact.value) for fact in section.facts}


@pytest.mark.quick("20.0-None", "20.0-motor2", "-20.0-motor2")
@pytest.mark.parametrize("motor", [None, MotorSpec("trapezoid"), MotorSpec("cycloid")])
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_the_drive_gives_what_the_load_takes_and_friction(motor: MotorSpec | None, speed: float) -> None:
    """A moment always against the rocker: useful work is what the drive gives, times the efficiency."""
    against = ((0, 50.0), (20, 50), (60, -50), (200, -50), (240, 50), (360, 50))
    spec = DynamicsSpec(
        3.0,
        speed_rpm=speed,
        gravity=(0, -9.81),
        loads=(LoadSpec(4, values=against),),
        friction=FrictionSpec(0.1, 0.05, viscous=0.4),
        motor=motor,
    )
    found = facts(spec)
    study = LinkageStudy.of(LinkageSpec(CRANK_ROCKER, "one", length_unit="m", dynamics=spec), Asked())
    (law,) = study.sweep.laws
    share = (np.arange(6_000) + 0.5) / 6_000
    state = law.state(CRANK_ROCKER, law.at_time(share * law.duration).theta2)
    masses, loads = stated_masses(CRANK_ROCKER, spec), stated_loads(spec, 1.0)
    given = inverse_dynamics(state, masses, loads).power
    taken = np.interp(np.degrees(state.theta2) % 360, *np.array(against).T)  # nearly the table's curve
    curve = loads.moments[0].moment
    assert callable(curve)
    assert np.abs(np.asarray(curve(state)) - taken).max() < 20
    work = float(np.mean(given)) * law.duration
    useful = -float(np.mean(np.asarray(curve(state)) * state.omega4)) * law.duration
    put_in = max(work, 0.0) + max(-useful, 0.0)
    assert found["friction_work"] == pytest.approx(work - useful, rel=1e-3)
    assert found["efficiency"] == pytest.approx(1 - (work - useful) / put_in, abs=1e-4)


def test_without_loads_friction_takes_all() -> None:
    assert facts(DynamicsSpec(3.0, friction=FrictionSpec(viscous=1.0)))["efficiency"] == pytest.approx(
        0, abs=1e-7
    )


def test_without_friction_or_motion_there_is_no_efficiency() -> None:
    assert "efficiency" not in facts(DynamicsSpec(3.0))
    assert "efficiency" not in facts(DynamicsSpec(3.0, speed_rpm=0, friction=FrictionSpec(viscous=1.0)))
    assert "efficiency" not in facts(DynamicsSpec(3.0, friction=FrictionSpec()))

"""The model for MuJoCo moves as the linkage does, and has its masses."""

import mujoco
import numpy as np
import pytest

from grashof.analysis import full_rotation, solve_kinematics, solve_position
from grashof.analysis.forces.energy import energies
from grashof.models import Model, mjcf
from grashof.problems import LinkageSpec, SliderCrank

AGREES = 1e-5  # rad, or the same share of the longest link


def opened(model: Model) -> tuple[mujoco.MjModel, mujoco.MjData]:
    made = mujoco.MjModel.from_xml_string(mjcf(model))
    data = mujoco.MjData(made)
    mujoco.mj_forward(made, data)
    return made, data


def wrapped(angle: float) -> float:
    return float((angle + np.pi) % (2 * np.pi) - np.pi)


def apart(model: Model, joints: dict[str, float]) -> float:
    """How far the joints are from where the linkage has them at the same driver angle."""
    at = solve_position(model.linkage, joints["O2"])
    found = [wrapped(joints["O2"] + joints["A"] - at.theta3)] if "A" in joints else []
    found += [wrapped(joints["O4"] - at.theta4)] if "O4" in joints else []
    if "slide" in joints:
        travel = float(at.travel)
        found.append((joints["slide"] / model.metre - travel) / float(model.linkage.lengths.max()))
    return float(np.abs(found).max())


def test_it_stands_assembled_where_its_motion_begins(model: Model) -> None:
    made, data = opened(model)
    assert made.neq == 1
    assert made.nv == 3
    assert np.abs(data.efc_pos).max() < 1e-12 * float(model.linkage.lengths.max())
    assert apart(model, dict(zip(names(made), data.qpos.tolist(), strict=True))) < 1e-12


@pytest.mark.quick("four-bar in in", "pumpjack")
def test_it_moves_as_the_linkage(model: Model) -> None:
    """A turn of the driver, or as far as one that swings comes within a third of its range."""
    made, data = opened(model)
    worst, way = 0.0, 2 * np.pi if model.turns else (model.high - model.low) / 3
    while abs(data.qpos[0] - model.start) < way and data.time < 2 * way / abs(model.omega2):
        mujoco.mj_step(made, data, 25)
        worst = max(worst, apart(model, dict(zip(names(made), data.qpos.tolist(), strict=True))))
    assert abs(data.qpos[0] - model.start) >= way
    assert np.sign(data.qpos[0] - model.start) == np.sign(model.omega2)
    assert worst < AGREES


def test_it_has_the_energy_of_the_linkage(model: Model) -> None:
    """At the speeds of the linkage: MuJoCo's kinetic energy against the sum over the links."""
    made, data = opened(model)
    state = solve_kinematics(model.linkage, model.start, model.omega2)
    speeds = {"O2": state.omega2, "A": state.omega3 - state.omega2, "O4": state.omega4}
    step = 1e-6
    beside = solve_position(model.linkage, model.start + np.array([-step, step]))
    rate = float(np.diff(beside.travel)[0]) / (2 * step) * model.omega2
    speeds["slide"] = rate * model.metre
    for number, name in enumerate(names(made)):
        data.qvel[number] = float(speeds[name])
    mujoco.mj_energyVel(made, data)
    kinetic = float(np.sum(energies(state, model.masses).kinetic)) * model.metre**2
    assert data.energy[1] == pytest.approx(kinetic, rel=2e-3)  # what is without mass has a little there


def names(made: mujoco.MjModel) -> list[str]:
    return [made.joint(number).name for number in range(made.njnt)]


def test_all_kinds_are_among_them(model: Model) -> None:
    assert model.turns == bool(full_rotation(model.linkage))


def test_a_watchmakers_linkage_is_not_too_light() -> None:
    """A slider of a hundredth of a gram of bars, in mm: MuJoCo refuses an inertia below 1e-15."""
    tiny = SliderCrank(
        o2=(0, 0), r2=0.3, r3=1, offset=0.1, slide_angle=0, coupler_point=(0.5, 0.1), assembly=1
    )
    made, _ = opened(Model.of(LinkageSpec(tiny, "tiny", length_unit="mm")))
    assert made.body_inertia[1:].min() > 1e-15

"""The model for MuJoCo moves as the linkage does, and has its masses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.analysis import solve_kinematics, solve_position
from grashof.analysis.forces.energy import energies
from grashof.models import Model, mjcf
from grashof.problems import LinkageSpec, SliderCrank
from grashof.problems.values.linkages.mechanism import DyadKind

pytestmark = pytest.mark.extra
mujoco: Any = pytest.importorskip("mujoco")

AGREES = 1e-5  # of the longest link


def opened(model: Model) -> tuple[mujoco.MjModel, mujoco.MjData]:
    made = mujoco.MjModel.from_xml_string(mjcf(model))
    data = mujoco.MjData(made)
    mujoco.mj_forward(made, data)
    return made, data


def apart(model: Model, made: mujoco.MjModel, data: mujoco.MjData) -> float:
    """How far its points are from those of the linkage at the same driver angle, of the longest link."""
    mujoco.mj_kinematics(made, data)
    kind, at = model.linkage.mechanism, solve_position(model.linkage, data.qpos[0])
    found = {made.site(number).name: data.site_xpos[number, :2] for number in range(made.nsite)}
    found |= {link.labels[0]: data.body(link.name).xpos[:2] for link in kind.links[1:]}
    if kind.dyads[0].kind is DyadKind.RPR:  # there the rod is marked where B is at first
        del found["B"]
    assert {name.upper() for name in kind.moving} - {"B"} <= {*found}
    away = [
        xy / model.metre - at.point(name.lower()) for name, xy in found.items() if name.lower() in kind.points
    ]
    return float(np.abs(away).max() / model.linkage.lengths.max())


def test_it_is_assembled_at_the_beginning_of_its_motion(model: Model) -> None:
    made, data = opened(model)
    assert made.neq == len(model.linkage.mechanism.dyads)
    assert made.nv == len(model.linkage.mechanism.links) - 1
    assert np.abs(data.efc_pos).max() < 1e-12 * float(model.linkage.lengths.max())
    assert apart(model, made, data) < 1e-12
    at = model.first
    for name, value in zip(names(made), data.qpos.tolist(), strict=True):
        if name.startswith("slide"):
            assert value == pytest.approx(
                float(at.loops[int(name[6:] or 1) - 1].travel) * model.metre, abs=1e-12
            )
        else:
            host, link = model.linkage.mechanism.joints[name.lower()]
            assert value == pytest.approx(
                float(at.angles[link]) - (float(at.angles[host]) if host > 1 else 0)
            )


@pytest.mark.quick("press of a watt-2")
def test_it_moves_as_the_linkage(model: Model) -> None:
    """A turn of the driver, or as far as one that swings comes within a third of its range."""
    made, data = opened(model)
    worst, way = 0.0, 2 * np.pi if model.turns else (model.high - model.low) / 3
    while abs(data.qpos[0] - model.start) < way and data.time < 2 * way / abs(model.omega2):
        mujoco.mj_step(made, data, 25)
        worst = max(worst, apart(model, made, data))
    assert abs(data.qpos[0] - model.start) >= way
    assert np.sign(data.qpos[0] - model.start) == np.sign(model.omega2)
    assert worst < AGREES


def test_it_has_the_energy_of_the_linkage(model: Model) -> None:
    """At the speeds of the linkage: MuJoCo's kinetic energy against the sum over the links."""
    made, data = opened(model)
    state = solve_kinematics(model.linkage, model.start, model.omega2)
    step = 1e-6
    beside = solve_position(model.linkage, model.start + np.array([-step, step]))
    turned = {1: np.zeros(2)} | beside.angles
    for number, name in enumerate(names(made)):
        if name.startswith("slide"):
            way = np.diff(beside.loops[int(name[6:] or 1) - 1].travel * model.metre)[0]
        else:
            host, link = model.linkage.mechanism.joints[name.lower()]
            way = np.diff(np.unwrap(turned[link]) - np.unwrap(turned[host]))[0]
        data.qvel[number] = float(way) / (2 * step) * model.omega2
    mujoco.mj_energyVel(made, data)
    kinetic = float(np.sum(energies(state, model.masses).kinetic)) * model.metre**2
    assert data.energy[1] == pytest.approx(kinetic, rel=2e-3)  # links without mass have a little there


def names(made: mujoco.MjModel) -> list[str]:
    return [made.joint(number).name for number in range(made.njnt)]


def test_a_watchmakers_linkage_is_not_too_light() -> None:
    """A slider of a hundredth of a gram of bars, in mm: MuJoCo refuses an inertia below 1e-15."""
    tiny = SliderCrank(
        o2=(0, 0), r2=0.3, r3=1, offset=0.1, slide_angle=0, coupler_point=(0.5, 0.1), assembly=1
    )
    made, _ = opened(Model.of(LinkageSpec(tiny, "tiny", length_unit="mm")))
    assert made.body_inertia[1:].min() > 1e-15

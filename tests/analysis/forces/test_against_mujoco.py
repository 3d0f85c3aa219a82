"""The same mechanism in a rigid-body engine that others wrote, its loop closed by an equality."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from grashof.analysis import (
    Kinematics,
    Masses,
    free_response,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.problems import DynamicsSpec, FourBar
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics.acting import (
    CounterweightSpec,
    Place,
    SpringSpec,
    TorsionSpringSpec,
)
from grashof.problems.values.dynamics.section import SectionSpec

mujoco: Any = pytest.importorskip("mujoco")

CRANK_ROCKER = FourBar((0.2, -0.1), (1.2, 0.3), 0.35, 1.1, 0.8, (0.5, 0.3))
DOUBLE_CRANK = FourBar((0, 0), (0.4, 0.1), 1.1, 0.9, 1.2, (0.4, -0.2), assembly=-1)
SPEC = DynamicsSpec(
    density=700.0,
    section=SectionSpec(0.04, 0.03),
    payload=0.5,
    gravity=(0.3, -9.81),
    springs=(SpringSpec((Place(1, (0.1, 0.9)), Place(4, (0.5, 0.1))), 40.0, 0.4),),
    torsion_springs=(TorsionSpringSpec((1, 2), 1.5, 20.0), TorsionSpringSpec((1, 4), 0.7, 100.0)),
    counterweights=(CounterweightSpec(2, 0.6, (-0.2, 0.05)),),
)
STEP = 2e-5  # s


def body(masses: Masses, link: int) -> str:
    """Its mass, centre and inertia, which the engine wants in three axes."""
    given = masses.of(link)
    u, v = given.centre.tolist()
    inertia = float(given.inertia)
    return (
        f'<inertial pos="{u!r} {v!r} 0" mass="{float(given.mass)!r}" '
        f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
    )


def engine(linkage: FourBar, masses: Masses, spec: DynamicsSpec) -> Any:
    """The mechanism as the engine's tree: link 2 with link 3 on it, link 4, B of both held together."""
    (o2x, o2y), (o4x, o4y) = linkage.o2.tolist(), linkage.o4.tolist()
    r2, r3, r4 = (float(getattr(linkage, name)) for name in ("r2", "r3", "r4"))
    (gx, gy), spring = spec.gravity, spec.springs[0]
    hinges = [
        f'stiffness="{each.stiffness}" springref="{float(np.radians(each.free_angle_deg))!r}"'
        for each in spec.torsion_springs
    ]
    ends = [end.at for end in spring.between]
    return mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <compiler angle="radian"/>
      <option gravity="{gx} {gy} 0" timestep="{STEP}" integrator="RK4" tolerance="1e-15" iterations="200">
        <flag contact="disable"/>
      </option>
      <worldbody>
        <site name="hook" pos="{ends[0][0]} {ends[0][1]} 0"/>
        <body pos="{o2x} {o2y} 0">{body(masses, 2)}<joint name="q2" axis="0 0 1" {hinges[0]}/>
          <body pos="{r2} 0 0">{body(masses, 3)}<joint name="q3" axis="0 0 1"/>
            <site name="b3" pos="{r3} 0 0"/>
          </body>
        </body>
        <body pos="{o4x} {o4y} 0">{body(masses, 4)}<joint name="q4" axis="0 0 1" {hinges[1]}/>
          <site name="b4" pos="{r4} 0 0"/><site name="eye" pos="{ends[1][0]} {ends[1][1]} 0"/>
        </body>
      </worldbody>
      <tendon>
        <spatial stiffness="{spring.stiffness}" springlength="{spring.free_length}">
          <site site="hook"/><site site="eye"/>
        </spatial>
      </tendon>
      <equality>
        <connect site1="b3" site2="b4" solref="{2 * STEP} 1" solimp="0.9999 0.9999 0.001"/>
      </equality>
    </mujoco>""")


def set_state(data: Any, state: Kinematics, k: int) -> FloatArray:
    """The engine in a state of ours; the accelerations of its joints."""
    # The engine's springs are wound without end, ours by less than half a turn.
    free = np.radians(SPEC.torsion_springs[1].free_angle_deg)
    theta4 = free + (state.theta4[k] - free + np.pi) % (2 * np.pi) - np.pi
    data.qpos[:] = state.theta2[k], state.theta3[k] - state.theta2[k], theta4
    data.qvel[:] = state.omega2[k], state.omega3[k] - state.omega2[k], state.omega4[k]
    return np.array([state.alpha2[k], state.alpha3[k] - state.alpha2[k], state.alpha4[k]])


@pytest.mark.parametrize("linkage", [CRANK_ROCKER, DOUBLE_CRANK])
def test_the_torque_is_what_the_engine_takes(linkage: FourBar) -> None:
    """Its mass matrix, its bias, its springs, its Jacobian of the loop; our accelerations."""
    masses, loads = stated_masses(linkage, SPEC), stated_loads(SPEC, 1.0)
    theta2 = np.linspace(0.1, 3.0, 40)
    state = solve_kinematics(linkage, theta2, 7.0, 11.0)
    found = inverse_dynamics(state, masses, loads)
    model = engine(linkage, masses, SPEC)
    data, matrix = mujoco.MjData(model), np.zeros((3, 3))
    scale, force_scale = np.abs(found.torque).max(), np.abs(found.f43).max()
    for k in range(len(theta2)):
        alpha = set_state(data, state, k)
        mujoco.mj_forward(model, data)
        loop = data.efc_J.reshape(-1, 3)[: data.ne]
        assert np.abs(data.efc_pos[: data.ne]).max() < 1e-12  # the loop is closed
        assert np.abs(loop @ data.qvel).max() < 1e-10
        mujoco.mj_fullM(model, data, matrix)
        demand = matrix @ alpha + data.qfrc_bias - data.qfrc_passive
        columns = np.column_stack([[1.0, 0.0, 0.0], loop[:2].T])
        torque, fx, fy = np.linalg.solve(columns, demand)
        assert torque == pytest.approx(found.torque[k], abs=1e-9 * scale)
        assert np.hypot(fx, fy) == pytest.approx(np.hypot(*found.f43[k]), abs=1e-9 * force_scale)


@pytest.mark.slow
def test_a_released_linkage_moves_as_in_the_engine() -> None:
    linkage = CRANK_ROCKER
    masses, loads = stated_masses(linkage, SPEC), stated_loads(SPEC, 1.0)
    time = np.linspace(0, 0.4, 21)
    ours = free_response(linkage, masses, time, 2.0, -8.0, loads=loads).state
    model = engine(linkage, masses, SPEC)
    data = mujoco.MjData(model)
    set_state(data, solve_kinematics(linkage, np.array([2.0]), -8.0), 0)
    stride = round((time[1] - time[0]) / STEP)
    worst = 0.0
    for k in range(1, len(time)):
        mujoco.mj_step(model, data, stride)
        angles = np.array([ours.theta2[k], ours.theta3[k] - ours.theta2[k], ours.theta4[k]])
        off = (data.qpos - angles + np.pi) % (2 * np.pi) - np.pi
        worst = max(worst, float(np.abs(off).max()))
    assert np.ptp(ours.theta2) > 4.0
    assert worst < 1e-8

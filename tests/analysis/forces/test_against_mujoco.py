"""Every kind of one loop in a rigid-body engine that others wrote, its loop closed by an equality."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from grashof.analysis import (
    Body,
    Kinematics,
    Masses,
    free_response,
    inverse_dynamics,
    solve_kinematics,
    stated_loads,
    stated_masses,
)
from grashof.problems import DynamicsSpec, FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.arrays import FloatArray
from grashof.problems.values.dynamics import load_specs as specs
from grashof.problems.values.dynamics.strength import SectionSpec
from grashof.problems.values.linkages.linkage import Linkage

pytestmark = pytest.mark.extra
mujoco: Any = pytest.importorskip("mujoco")

CRANK_ROCKER = FourBar((0.2, -0.1), (1.2, 0.3), 0.35, 1.1, 0.8, (0.5, 0.3))
DOUBLE_CRANK = FourBar((0, 0), (0.4, 0.1), 1.1, 0.9, 1.2, (0.4, -0.2), assembly=-1)
ENGINE = SliderCrank((0.2, -0.1), 0.35, 1.1, 0.15, 0.4, (0.5, 0.3))
BACKWARDS = SliderCrank((0.2, -0.1), 0.35, 1.1, -0.15, 2.0, (0.5, 0.3), assembly=-1)
SHAPER = InvertedSliderCrank((0.2, -0.1), (1.2, 0.3), 0.35, 0.2, (0.5, 0.3))
WHITWORTH = InvertedSliderCrank((0, 0), (0.4, 0.1), 1.1, -0.2, (-0.4, 0.3), assembly=-1)
IN_O2, IN_O4 = specs.TorsionSpringSpec((1, 2), 1.5, 20.0), specs.TorsionSpringSpec((1, 4), 0.7, 100.0)
SPEC = DynamicsSpec(
    density=700.0,
    section=SectionSpec(0.04, 0.03),
    payload=0.5,
    gravity=(0.3, -9.81),
    springs=(specs.SpringSpec((specs.Place(1, (0.1, 0.9)), specs.Place(4, (0.5, 0.1))), 40.0, 0.4),),
    torsion_springs=(IN_O2,),
    counterweights=(specs.CounterweightSpec(2, 0.6, (-0.2, 0.05)),),
)
SLIDER = Body(0.9, 0.01, (0.1, 0.05))  # of slider or block: bars leave them without mass
STEP = 2e-5  # s


def spec_of(linkage: Linkage) -> DynamicsSpec:
    return replace(SPEC, torsion_springs=(IN_O2, IN_O4)) if isinstance(linkage, FourBar) else SPEC


def masses_of(linkage: Linkage) -> Masses:
    """The bars, and a slider or block."""
    bars = stated_masses(linkage, spec_of(linkage))
    return bars if isinstance(linkage, FourBar) else bars.with_body(4, SLIDER)


def body(masses: Masses, link: int) -> str:
    """Its mass, centre and inertia, which the engine wants in three axes."""
    given = masses.of(link)
    u, v = given.centre.tolist()
    inertia = float(given.inertia)
    return (
        f'<inertial pos="{u!r} {v!r} 0" mass="{float(given.mass)!r}" '
        f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
    )


def hinge(name: str, spring: specs.TorsionSpringSpec) -> str:
    free = float(np.radians(spring.free_angle_deg))
    return f'<joint name="{name}" axis="0 0 1" stiffness="{spring.stiffness}" springref="{free!r}"/>'


def links(linkage: Linkage, masses: Masses) -> str:
    """Link 2, in a four-bar or slider-crank link 3 on it, and link 4; s2 and s3 are to be held together."""
    (o2x, o2y), r2 = linkage.o2.tolist(), float(linkage.r2)
    crank = f'<body pos="{o2x} {o2y} 0">{body(masses, 2)}{hinge("q2", IN_O2)}'
    eye = '<site name="eye" pos="0.5 0.1 0"/>'
    if isinstance(linkage, InvertedSliderCrank):
        (o4x, o4y), offset = linkage.o4.tolist(), float(linkage.offset)
        # The rod on the block: its frame, a right angle behind the block's, begins in A, -travel from B.
        return f"""
        {crank}<site name="s2" pos="{r2} 0 0"/></body>
        <body pos="{o4x} {o4y} 0">{body(masses, 4)}<joint name="q4" axis="0 0 1"/>{eye}
          <body pos="{offset} 0 0" euler="0 0 {-np.pi / 2!r}">{body(masses, 3)}
            <joint name="q3" type="slide" axis="-1 0 0"/><site name="s3" pos="0 0 0"/>
          </body>
        </body>"""
    if isinstance(linkage, FourBar):
        (o4x, o4y), r4 = linkage.o4.tolist(), float(linkage.r4)
        output = f"""
        <body pos="{o4x} {o4y} 0">{body(masses, 4)}{hinge("q4", IN_O4)}
          <site name="s3" pos="{r4} 0 0"/>{eye}
        </body>"""
    else:
        assert isinstance(linkage, SliderCrank)
        angle, offset = float(linkage.slide_angle), float(linkage.offset)
        x, y = o2x - offset * float(np.sin(angle)), o2y + offset * float(np.cos(angle))
        output = f"""
        <body pos="{x!r} {y!r} 0" euler="0 0 {angle!r}">{body(masses, 4)}
          <joint name="q4" type="slide" axis="1 0 0"/><site name="s3" pos="0 0 0"/>{eye}
        </body>"""
    return f"""
        {crank}
          <body pos="{r2} 0 0">{body(masses, 3)}<joint name="q3" axis="0 0 1"/>
            <site name="s2" pos="{float(linkage.r3)} 0 0"/>
          </body>
        </body>{output}"""


def engine(linkage: Linkage, masses: Masses) -> Any:
    (gx, gy), spring = SPEC.gravity, SPEC.springs[0]
    hook = spring.between[0].at
    return mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <compiler angle="radian"/>
      <option gravity="{gx} {gy} 0" timestep="{STEP}" integrator="RK4" tolerance="1e-15" iterations="200">
        <flag contact="disable"/>
      </option>
      <worldbody><site name="hook" pos="{hook[0]} {hook[1]} 0"/>{links(linkage, masses)}</worldbody>
      <tendon>
        <spatial stiffness="{spring.stiffness}" springlength="{spring.free_length}">
          <site site="hook"/><site site="eye"/>
        </spatial>
      </tendon>
      <equality>
        <connect site1="s2" site2="s3" solref="{2 * STEP} 1" solimp="0.9999 0.9999 0.001"/>
      </equality>
    </mujoco>""")


def joints(state: Kinematics) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places, velocities and accelerations of the engine's joints, in their order, a row each."""
    rows = zip(state.angular(2)[:3], state.angular(3)[:3], state.angular(4)[:3], strict=True)
    if state.slide is None:
        columns = [(two, three - two, four) for two, three, four in rows]
        # The engine's springs are wound without end, ours by less than half a turn.
        free, theta4 = np.radians(IN_O4.free_angle_deg), columns[0][2]
        columns[0] = (*columns[0][:2], free + (theta4 - free + np.pi) % (2 * np.pi) - np.pi)
    else:
        travel = state.slide.travel, state.slide.velocity, state.slide.acceleration
        sliding = zip(rows, travel, strict=True)
        if isinstance(state.linkage, SliderCrank):
            columns = [(two, three - two, slid) for (two, three, _), slid in sliding]
        else:
            columns = [(two, four, slid) for (two, _, four), slid in sliding]
    place, rate, bend = (np.stack(np.broadcast_arrays(*each), axis=-1) for each in columns)
    return place, rate, bend


@pytest.mark.parametrize("linkage", [CRANK_ROCKER, DOUBLE_CRANK, ENGINE, BACKWARDS, SHAPER, WHITWORTH])
def test_the_torque_is_that_of_the_engine(linkage: Linkage) -> None:
    """Its mass matrix, its bias, its springs, its Jacobian of the loop; our accelerations."""
    masses, loads = masses_of(linkage), stated_loads(spec_of(linkage), 1.0)
    theta2 = np.linspace(0.1, 3.0, 40)
    state = solve_kinematics(linkage, theta2, 7.0, 11.0)
    found = inverse_dynamics(state, masses, loads)
    model = engine(linkage, masses)
    data, matrix = mujoco.MjData(model), np.zeros((3, 3))
    held = found.f32 if isinstance(linkage, InvertedSliderCrank) else found.f43
    scale, force_scale = np.abs(found.torque).max(), np.abs(held).max()
    places, rates, accelerations = joints(state)
    for k in range(len(theta2)):
        data.qpos[:], data.qvel[:] = places[k], rates[k]
        mujoco.mj_forward(model, data)
        loop = data.efc_J.reshape(-1, 3)[: data.ne]
        assert np.abs(data.efc_pos[: data.ne]).max() < 1e-12  # the loop is closed
        assert np.abs(loop @ data.qvel).max() < 1e-10
        mujoco.mj_fullM(model, data, matrix)
        demand = matrix @ accelerations[k] + data.qfrc_bias - data.qfrc_passive
        columns = np.column_stack([[1.0, 0.0, 0.0], loop[:2].T])
        torque, fx, fy = np.linalg.solve(columns, demand)
        assert torque == pytest.approx(found.torque[k], abs=1e-9 * scale)
        assert np.hypot(fx, fy) == pytest.approx(np.hypot(*held[k]), abs=1e-9 * force_scale)


@pytest.mark.slow
@pytest.mark.quick("linkage0-4.0", "linkage1-1.3")
@pytest.mark.parametrize(("linkage", "swept"), [(CRANK_ROCKER, 4.0), (ENGINE, 1.3), (SHAPER, 1.3)])
def test_a_released_linkage_moves_as_in_the_engine(linkage: Linkage, swept: float) -> None:
    masses, loads = masses_of(linkage), stated_loads(spec_of(linkage), 1.0)
    time = np.linspace(0, 0.4, 21)
    ours = free_response(linkage, masses, time, 2.0, -8.0, loads=loads).state
    model = engine(linkage, masses)
    data = mujoco.MjData(model)
    places, rates, _ = joints(solve_kinematics(linkage, np.array([2.0]), -8.0))
    data.qpos[:], data.qvel[:] = places[0], rates[0]
    stride, worst = round((time[1] - time[0]) / STEP), 0.0
    expected = joints(ours)[0]
    for k in range(1, len(time)):
        mujoco.mj_step(model, data, stride)
        off = data.qpos - expected[k]
        off = np.where([model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE for j in range(3)],
                       (off + np.pi) % (2 * np.pi) - np.pi, off)  # fmt: skip
        worst = max(worst, float(np.abs(off).max()))
    assert np.ptp(ours.theta2) > swept
    assert worst < 1e-8

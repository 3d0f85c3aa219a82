"""Kinematics and dynamics of one four-bar against a plain closed form in NumPy, pylinkage and MuJoCo.

``--count`` is the number of driver angles. The two packages come with ``pip install '.[bench]'``; one that is
not installed is left out.
"""

from collections.abc import Callable, Iterator
from functools import partial
from importlib import import_module
from statistics import median
from typing import Any

import numpy as np
import numpy.typing as npt
from measuring import Case, timed

from grashof.analysis import Loads, inverse_dynamics, solve_kinematics, solve_position, uniform_bars
from grashof.models import Model, mjcf
from grashof.problems import DynamicsSpec, FourBar, LinkageSpec
from grashof.problems.values.arrays import TURN

NORTON = FourBar(o2=(0, 0), o4=(100, 0), r2=40, r3=120, r4=80, coupler_point=(60, 20))
ANGLES, RUNS = 100_000, 21
Array = npt.NDArray[np.float64]


def plain(theta2: Array, omega2: float) -> tuple[Array, ...]:  # closure: RRR
    """Angles, velocities and accelerations of links 3 and 4: three angles, two 2x2 solves, no more."""
    r1, r2, r3, r4 = map(float, NORTON.lengths)
    cos2, sin2 = np.cos(theta2), np.sin(theta2)
    x, y = r1 - r2 * cos2, -r2 * sin2
    square = x * x + y * y
    theta3 = np.arctan2(y, x) + np.arccos((square + r3 * r3 - r4 * r4) / (2 * r3 * np.sqrt(square)))
    cos3, sin3 = np.cos(theta3), np.sin(theta3)
    theta4 = np.arctan2(r3 * sin3 - y, r3 * cos3 - x)
    cos4, sin4 = np.cos(theta4), np.sin(theta4)
    determinant = r3 * r4 * (sin3 * cos4 - cos3 * sin4)

    def solved(x: Array, y: Array) -> tuple[Array, Array]:
        return (-x * r4 * cos4 - y * r4 * sin4) / determinant, (-y * r3 * sin3 - x * r3 * cos3) / determinant

    omega3, omega4 = solved(r2 * omega2 * sin2, -r2 * omega2 * cos2)
    right_x = r2 * omega2**2 * cos2 + r3 * omega3**2 * cos3 - r4 * omega4**2 * cos4
    right_y = r2 * omega2**2 * sin2 + r3 * omega3**2 * sin3 - r4 * omega4**2 * sin4
    return theta3, theta4, omega3, omega4, *solved(right_x, right_y)


def milliseconds(*functions: Callable[[], object]) -> list[float]:
    """Median time of each; they take turns, so that a busy machine slows all alike."""
    rounds = [[timed(function)[1] for function in functions] for _ in range(RUNS)]
    return [1e3 * median(seconds) for seconds in zip(*rounds, strict=True)]


def many_angles(count: int, seed: int) -> Iterator[str]:
    """One linkage at many driver angles."""
    del seed
    theta2 = np.linspace(0, 2 * np.pi, count)
    state = solve_kinematics(NORTON, theta2, 2.0)
    found = (state.theta3, state.theta4, state.omega3, state.omega4, state.alpha3, state.alpha4)
    apart = max(float(np.abs(a - b).max()) for a, b in zip(plain(theta2, 2.0), found, strict=True))
    masses, loads = uniform_bars(NORTON, 2.0, payload=3.0), Loads(gravity=(0, -9810))
    closed, ours, points, forces = milliseconds(
        lambda: plain(theta2, 2.0),
        lambda: solve_kinematics(NORTON, theta2, 2.0),
        lambda: (state.a, state.b, state.p),
        lambda: inverse_dynamics(state, masses, loads),
    )
    yield f"plain closed form {closed:.1f} ms"
    yield (
        f"kinematics with jerk {ours:.1f} ms, {ours / closed:.2f} times the plain form, "
        f"largest difference {apart:.0e}"
    )
    yield f"motion of A, B and P {points:.1f} ms more"
    yield f"inverse dynamics {forces:.1f} ms, {forces / ours:.1f} times the kinematics"


def many_linkages(count: int, seed: int, angles: int = 64) -> Iterator[str]:
    """Random linkages, all at the same angles."""
    rng = np.random.default_rng(seed)
    o4 = np.stack([rng.uniform(90, 110, count), rng.uniform(-5, 5, count)], axis=-1)
    r2, r3, r4 = rng.uniform(30, 40, count), rng.uniform(110, 130, count), rng.uniform(75, 85, count)
    linkages = FourBar(o2=np.zeros((count, 2)), o4=o4, r2=r2, r3=r3, r4=r4)[:, None]
    _, seconds = timed(lambda: solve_kinematics(linkages, np.linspace(0, 2 * np.pi, angles)))
    each = seconds / (count * angles) * 1e9
    yield f"{count} linkages at {angles} angles in {seconds:.2f} s, {each:.0f} ns each"


def against(package: str, compared: Callable[[Any, int], str], count: int, seed: int) -> Iterator[str]:
    """A comparison with another package, where it is installed."""
    del seed
    try:
        module = import_module(package)
    except ModuleNotFoundError:
        yield "not installed"
        return
    yield compared(module, count)


def with_pylinkage(conversion: Any, count: int) -> str:
    """The same turn by pylinkage's compiled solver: joints alone, and with rates and accelerations."""
    r1, r2, r3, r4 = map(float, NORTON.lengths)
    made = conversion.fourbar_from_lengths(r2, r3, r4, r1, iterations=count)
    made.set_input_velocity(made._cranks[0], omega=2.0)
    made.compile()
    path = made.step_fast(count)  # compiles
    made.step_fast_with_kinematics(2)
    columns = [each.__class__.__name__ for each in made.components]
    crank = columns.index("Crank")
    a, b = path[:, crank], path[:, len(columns) - 1]
    theta2 = np.arctan2(a[:, 1], a[:, 0])
    apart = np.abs(solve_position(NORTON, theta2).b - b).max()
    joints, rates, ours = milliseconds(
        lambda: made.step_fast(count),
        lambda: made.step_fast_with_kinematics(count),
        lambda: (state := solve_kinematics(NORTON, theta2, 2.0), state.a, state.b),
    )
    return (
        f"{joints:.1f} ms for joints, {rates:.1f} ms with velocities and accelerations, "
        f"against {ours:.1f} ms; B differs by {apart / r1:.0e} of r1"
    )


def with_mujoco(mujoco: Any, count: int) -> str:
    """Steps of MuJoCo with the model that `grashof export` writes, against inverse dynamics."""
    spec = DynamicsSpec(mass_per_length=2.0, gravity=(0, -9.81), speed_rpm=60 / np.pi)
    model = Model.of(LinkageSpec(NORTON, "norton", length_unit="mm", dynamics=spec))
    made = mujoco.MjModel.from_xml_string(mjcf(model))
    data = mujoco.MjData(made)
    theta2 = np.linspace(0, TURN, count)
    masses, loads = uniform_bars(NORTON, 2.0), Loads(gravity=(0, -9810))
    worst = 0.0
    for _ in range(200):
        mujoco.mj_step(made, data, max(1, count // 2000))
        at = solve_kinematics(NORTON, float(data.qpos[0]))
        off = float(data.qpos[0] + data.qpos[1] - at.theta3)
        worst = max(worst, abs((off + np.pi) % TURN - np.pi))
    steps, ours = milliseconds(
        lambda: mujoco.mj_step(made, data, count),
        lambda: inverse_dynamics(solve_kinematics(NORTON, theta2, 2.0), masses, loads),
    )
    return (
        f"{steps:.0f} ms for {count} steps, {steps / ours:.0f} times kinematics and inverse dynamics at as "
        f"many angles ({ours:.0f} ms); its coupler angle differs by {worst:.0e} rad"
    )


CASES = [
    Case("one linkage", ANGLES, many_angles),
    Case("many linkages", ANGLES, many_linkages),
    Case("pylinkage with numba", ANGLES, partial(against, "pylinkage.synthesis.conversion", with_pylinkage)),
    Case("MuJoCo", ANGLES, partial(against, "mujoco", with_mujoco)),
]

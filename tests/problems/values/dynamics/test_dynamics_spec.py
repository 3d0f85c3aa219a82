"""Masses, speeds, and how exactly linkages are made: the value types, and their tables in a file."""

import math
import pickle
import tomllib
from dataclasses import replace
from typing import Any

import pytest
from refusals import refusal, rows

from grashof.problems import DynamicsSpec, Manufacturing, ProblemError, load
from grashof.problems.files.problem_schema import problem_from
from grashof.problems.values.dynamics.dynamics_spec import metres

HEAD = 'kind = "motion"\nlength_unit = "mm"\nmotion.poses = [[0, 0, 0], [3, 4, 90]]\n'
BARS = "mass_per_length = 2\n"


def stated(table: str, name: str = "dynamics", head: str = HEAD) -> object:
    return getattr(problem_from(tomllib.loads(f"{head}[{name}]\n{table}"), "test"), name)


def test_by_default_the_driver_turns_at_one_radian_a_second_without_weight() -> None:
    spec = DynamicsSpec(2.0)
    assert spec.omega2 == pytest.approx(1.0, abs=1e-15)
    assert (spec.gravity, spec.payload, spec.masses, spec.inertias) == ((0.0, 0.0), 0.0, None, None)
    assert DynamicsSpec(2.0, speed_rpm=60).omega2 == pytest.approx(2 * math.pi)
    assert pickle.loads(pickle.dumps(spec)) == spec == DynamicsSpec(2)
    hash(spec)


def test_a_linkage_may_turn_either_way_without_masses() -> None:
    spec = DynamicsSpec(speed_rpm=-60, gravity=(0, -1))
    assert not spec.has_masses
    assert spec.omega2 == pytest.approx(-2 * math.pi)
    assert DynamicsSpec(payload=1).has_masses
    for each in (spec, DynamicsSpec(masses=(1, 2, 3), inertias=(0, 0, 1))):
        assert DynamicsSpec(**each.stated) == each
    assert "masses" not in spec.stated


def test_a_linkage_is_to_be_as_exact_as_its_parts_by_default() -> None:
    made = Manufacturing(0.3)
    assert (made.length_tolerance, made.band) == (0.3, 0.3)
    assert made.deviation == pytest.approx(0.1)
    assert made == Manufacturing(0.3, 0.3) != Manufacturing(0.3, band=0.5)
    assert pickle.loads(pickle.dumps(made)) == made


def test_the_luggage_has_the_masses_of_the_report() -> None:
    spec = load("luggage").dynamics
    assert spec is not None
    assert spec.masses == (0.3764, 0.4762, 0.4308)
    assert spec.inertias == (0.3282, 0.6646, 0.4920)
    assert spec.omega2 == pytest.approx(1.0, abs=1e-15)
    assert spec.gravity == (0.0, -9.81)


@pytest.mark.parametrize(
    ("name", "table", "expected"),
    [
        (
            "dynamics",
            BARS + "speed_rpm = 10\ngravity = [0, -9.80665]\npayload = 20",
            DynamicsSpec(2.0, speed_rpm=10.0, gravity=(0.0, -9.80665), payload=20.0),
        ),
        ("manufacturing", "length_tolerance = 0.1", Manufacturing(0.1, 0.1)),
        ("manufacturing", "length_tolerance = 0.1\nband = 0.25", Manufacturing(0.1, 0.25)),
    ],
)
def test_every_key_reaches_its_field(name: str, table: str, expected: DynamicsSpec | Manufacturing) -> None:
    head = HEAD if name == "dynamics" else HEAD.replace('length_unit = "mm"\n', "")  # masses alone need it
    assert stated(table, name, head) == expected


def test_known_length_units() -> None:
    for unit, length in {"mm": 0.001, "cm": 0.01, "m": 1.0, "in": 0.0254, "ft": 12 * 0.0254}.items():
        assert metres(unit) == pytest.approx(length, rel=1e-15)
    assert replace(load("luggage"), dynamics=None, length_unit="furlong").length_unit == "furlong"


@pytest.mark.parametrize("unit", ["", "M"])
def test_torque_needs_a_known_length_unit(unit: str) -> None:
    expected = f"length_unit is {unit!r}; it must be one of mm, cm, m, in, ft with dynamics"
    assert refusal(stated, BARS, head=HEAD.replace('"mm"', f'"{unit}"')) == expected
    assert refusal(replace, load("luggage"), length_unit=unit) == expected


TEXTS = {
    "BARS": BARS,
    "ZERO": "it must be a number from zero",
    "MORE": "it must be a number greater than zero",
}
BAD_DYNAMICS = r"""
# | dynamics has no mass;
    mass_per_length is needed, masses and inertias, density or payload, or else loads, springs or friction
masses = [1, 2, 3] | dynamics.inertias is missing; masses and inertias are needed together
inertias = [1, 2, 3] | dynamics.masses is missing; masses and inertias are needed together
<BARS>inertias = [1, 2, 3] |
    dynamics.mass_per_length does not go with masses and inertias; give one or the other
mass_per_length = 0 | dynamics.mass_per_length is 0; <MORE>
mass_per_length = inf | dynamics.mass_per_length is inf; it must be a finite number
<BARS>speed_rpm = 0 | dynamics.speed_rpm is 0; <MORE>
<BARS>payload = -1 | dynamics.payload is -1; <ZERO>
<BARS>gravity = 9.81 | dynamics.gravity is 9.81; it must be [x, y] in m/s2
<BARS>gravity = [0] | dynamics.gravity has 1 entry; it must have 2 numbers
<BARS>gravity = [0, nan] | dynamics.gravity[1] is nan; it must be a finite number
masses = [1, 2]\ninertias = [1, 2, 3] | dynamics.masses has 2 entries; it must have 3 numbers
masses = [1, -2, 3]\ninertias = [1, 2, 3] | dynamics.masses[1] is -2; <ZERO>
masses = 3\ninertias = [1, 2, 3] | dynamics.masses is 3; it must be [m2, m3, m4]
masses = [0, 0, 0]\ninertias = [0, 0, 0] | dynamics.masses are all zero; one at least has a mass
<BARS>speed = 10 | dynamics.speed is unknown; did you mean speed_rpm?
<BARS>colour = 10 |
    dynamics.colour is unknown; the keys are speed_rpm, gravity, mass_per_length, density, masses, inertias,
    centres, payload
"""
BAD_MANUFACTURING = r"""
# | manufacturing.length_tolerance is missing
length_tolerance = 0 | manufacturing.length_tolerance is 0; <MORE>
length_tolerance = '0.1' | manufacturing.length_tolerance is '0.1'; it must be a number
length_tolerance = inf | manufacturing.length_tolerance is inf; it must be a finite number
length_tolerance = 0.1\nband = 0 | manufacturing.band is 0; <MORE>
length_tolerance = 0.1\nsamples = 9 | manufacturing.samples is unknown; the keys are length_tolerance, band
tolerance = 0.1\nlength_tolerance = 0.1 | manufacturing.tolerance is unknown; did you mean length_tolerance?
"""
BAD = [("dynamics", *row) for row in rows(BAD_DYNAMICS, **TEXTS)]
BAD += [("manufacturing", *row) for row in rows(BAD_MANUFACTURING, **TEXTS)]


@pytest.mark.parametrize(("name", "table", "expected"), BAD)
def test_bad_tables(name: str, table: str, expected: str) -> None:
    assert refusal(stated, table, name) == expected


@pytest.mark.parametrize(
    "given",
    [
        {"masses": 3, "inertias": (1, 2, 3)},
        {"mass_per_length": None, "masses": (1, 2, "3"), "inertias": (1, 2, 3)},
        {"mass_per_length": 2, "gravity": None},
        {"mass_per_length": 2, "payload": "heavy"},
    ],
)
def test_bad_dynamics_from_python(given: dict[str, Any]) -> None:
    with pytest.raises(ProblemError, match=r"^dynamics\."):
        DynamicsSpec(**given)

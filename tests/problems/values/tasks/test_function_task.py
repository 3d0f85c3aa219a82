import pickle
from typing import Any

import numpy as np
import pytest
from refusals import refusal

from grashof.problems import Box, FunctionLaw, FunctionTask, Problem, Requirements, Rotatability
from grashof.problems.values.requirements.function_ground import FunctionGround, grounded
from grashof.problems.values.tasks.function_law import LAWS, chebyshev_spacing, lobatto_with_weights

RANGES: dict[str, Any] = {"input_range_deg": 60, "output_range_deg": 90}
XS = {"log10": (1, 2), "ln": (1, 2), "exp": (0, 1), "sin": (0, 90), "cos": (0, 90), "tan": (0, 45)}
XS |= {"sqrt": (1, 4), "reciprocal": (1, 2), "power": (1, 4)}


@pytest.mark.parametrize("name", LAWS)
def test_laws_run_over_their_ranges(name: str) -> None:
    law = FunctionLaw(name, XS[name], 1.0, 1.5, 1.5 if name == "power" else None)
    output = law.output(np.linspace(0, 1, 101))
    assert output[[0, -1]] == pytest.approx([0, 1.5])
    assert (np.diff(output) > 0).all()


def test_a_law_that_turns_back_spans_its_range() -> None:
    task = FunctionTask.from_degrees(law="sin", x=(0, 180), **RANGES)
    output = np.degrees(task.output(np.linspace(0, task.inputs[-1], 2001)))
    assert output.max() == pytest.approx(90)
    assert output[[0, -1]] == pytest.approx([0, 0])


def test_a_callable_is_the_law_that_it_is() -> None:
    tasks = [
        FunctionTask.from_degrees(law=law, x=(1, 2), **RANGES, pairs=5)
        for law in ("log10", lambda x: np.log10(x))
    ]
    turned = np.linspace(*tasks[0].span, 50)
    assert np.abs(tasks[0].output(turned) - tasks[1].output(turned)).max() < 1e-12
    assert pickle.loads(pickle.dumps(Problem(task=tasks[1]))).task.output(0.3) == tasks[1].output(0.3)


def test_weights_of_a_law_integrate() -> None:
    at, weights = lobatto_with_weights(41)
    for power in range(40):
        assert (weights * at**power).mean() == pytest.approx(1 / (power + 1))


def test_chebyshev_pairs_lie_inside_the_range() -> None:
    task = FunctionTask.from_degrees(law="log10", x=(1, 2), **RANGES, pairs=5)
    low, high = np.degrees(task.span)
    assert high - low == pytest.approx(60)
    assert -low == pytest.approx(60 * chebyshev_spacing(5)[0])
    assert task.beyond == pytest.approx(np.radians([-low, -low]))
    assert task.exact_by_default


@pytest.mark.parametrize("count", [3, 5, 6, 30])
def test_the_wanted_output_passes_through_all_pairs(count: int) -> None:
    rng = np.random.default_rng(count)
    inputs = np.append(0, np.cumsum(rng.uniform(0.01, 0.2, count - 1)))
    outputs = np.append(0, np.cumsum(rng.uniform(-0.1, 0.2, count - 1)))
    task = FunctionTask(inputs, outputs)
    assert np.abs(task.output(task.inputs) - outputs).max() < 1e-12
    assert task.exact_by_default == (count <= 5)


def test_the_ground_is_placed_within_its_limits() -> None:
    ground = FunctionGround.of(Requirements(o2=Box((0, 0), (0, 0)), o4=Box((0, 0), (200, 300))))
    assert (np.degrees(ground.theta1), ground.length) == (90.0, 200.0)
    assert ground.placed(250.0) == ((0.0, 0.0), (0.0, 250.0))


def test_a_travel_may_have_any_size() -> None:
    for size in (1e-9, 1.0, 1e8):
        task = FunctionTask([0, 1, 2], [0, 3 * size, 2 * size], travels=True)
        assert task.size == task.output_unit == 3 * size
        assert task.output(1.0) == pytest.approx(3 * size)
    law = FunctionTask.from_degrees(law="sin", x=(0, 180), input_range_deg=60, output_range=400.0, pairs=5)
    assert law.size == 400
    assert grounded(law, Requirements(r1=(7, 9))) is law


def test_four_pairs_are_met_by_all_kinds_whose_output_turns() -> None:
    four, five = (FunctionTask(np.arange(n), np.arange(n) ** 1.2) for n in (4, 5))
    kinds = ["four-bar", "inverted-slider-crank"]
    assert Problem(task=four, mechanism=kinds).requirements.is_exact(four)
    assert not Problem(task=five, mechanism=kinds).requirements.is_exact(five)
    assert Problem(task=five).requirements.is_exact(five)
    slide = FunctionTask(five.inputs, five.outputs, travels=True)
    assert Problem(task=slide, mechanism="slider-crank").requirements.is_exact(slide)


def test_rotatability_is_any_unless_it_is_stated() -> None:
    task = FunctionTask([0, 1, 2], [0, 1, 2])
    assert Problem(task=task).requirements.rotatability is Rotatability.ANY
    stated = Requirements(rotatability=Rotatability.FULL_CRANK)
    assert Problem(task=task, requirements=stated).requirements.rotatability is Rotatability.FULL_CRANK


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"input_deg": [0, 20], "output_deg": [0, 1]}, "function has 2 pairs; it must have three or more"),
        ({"input_deg": [0, 20, 10], "output_deg": [0, 1, 2]}, "function.input_deg[2] is 10 after 20"),
        ({"input_deg": [0, 20, 400], "output_deg": [0, 1, 2]}, "function.input_deg covers 400 deg"),
        ({"input_deg": [0, 20, 30], "output_deg": [0, 1, 400]}, "function.output_deg covers 400 deg"),
        ({"input_deg": [0, 20, np.nan], "output_deg": [0, 1, 2]}, "function.input_deg[2] is nan"),
        ({"input_deg": [5, 20, 30], "output_deg": [0, 1, 2]}, "function.input_deg[0] is 5; it must be 0"),
        ({"input_deg": [0, 20, 30], "output_deg": [0, 0, 0]}, "function.output_deg does not move"),
        (
            {"input_deg": [0, 1, 2], "output_deg": [0, 1, 2], "norm": "mx"},
            "function.norm is 'mx'; it must be one of rms, max",
        ),
        ({"law": "log", "x": (1, 2), **RANGES}, "function.law 'log' is unknown; did you mean log10?"),
        ({"law": "log10", "x": (-1, 2), **RANGES}, "function.law log10 has no value at x = -1"),
        ({"law": "tan", "x": (0, 100), **RANGES}, "function.law tan has no value at x = 90"),
        ({"law": "reciprocal", "x": (-1, 2), **RANGES}, "function.law reciprocal has no value at x = 0"),
        ({"law": "power", "x": (1, 2), **RANGES}, "function.exponent is missing"),
        ({"law": "power", "x": (1, 2), "exponent": 0.0, **RANGES}, "function.law power is constant"),
        ({"law": "sin", "x": (0, 90), **RANGES, "input_range_deg": 361}, "function.input_range_deg is 361"),
        ({"law": "sin", "x": (0, 90), **RANGES, "pairs": 2}, "function.pairs"),
        ({"law": lambda x: 1 / (x - 1.5) ** 0.5, "x": (1, 2), **RANGES}, "function.law sampled has no value"),
    ],
)
def test_bad_input_gets_a_line(given: dict[str, Any], message: str) -> None:
    line = refusal(FunctionTask.from_degrees, **given)
    assert line.startswith(message)
    assert "\n" not in line

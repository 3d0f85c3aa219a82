"""Programmes of many targets: the same derivatives, and an end when asked to stop."""

import casadi as ca
import numpy as np
import pytest

from grashof.analysis import verify
from grashof.analysis.judge.planted import planted_path
from grashof.problems import PathTask, Problem, Requirements
from grashof.synth.programme import nonlinear_programme as nlp
from grashof.synth.programme.builder import STOPPED, IterationCallback, jacobian_by_rows
from grashof.synth.programme.start import Start
from grashof.synth.programme.structure import Form
from grashof.synth.quantities.scaled_problem import ScaledProblem
from grashof.synth.theory import stopping


def noisy_start(count: int) -> tuple[ScaledProblem, Start]:
    """A start at the linkage of a noisy path."""
    rng = np.random.default_rng(5)
    task, linkage = planted_path(rng, count)
    points = task.points + rng.normal(0, 0.01 * task.size, task.points.shape)
    problem = Problem(task=PathTask(points), requirements=Requirements(exact=False))
    scaled = ScaledProblem.of(problem)
    return scaled, Start.of_linkage(scaled, linkage, verify(linkage, problem.task, problem.requirements))


def test_a_jacobian_in_blocks_is_the_jacobian() -> None:
    scaled, start = noisy_start(nlp.LONG + 40)
    with nlp.numpy_on_symbols():
        build, cost = nlp._stated(Form.of(scaled, start), (), None)
    stated = build.stated(cost)
    given = build.programme(cost, {"print_time": False, "ipopt": {"print_level": 0}}).arguments(scaled, start)
    whole = ca.Function("whole", [stated["x"], stated["p"]], [ca.jacobian(stated["g"], stated["x"])])
    _, found = jacobian_by_rows(stated)(given["x0"], given["p"])
    expected = whole(given["x0"], given["p"])
    assert found.sparsity() == expected.sparsity()
    np.testing.assert_allclose(np.array(found.nonzeros()), np.array(expected.nonzeros()), atol=1e-12)


def test_a_long_solve_ends_when_that_is_overdue(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stopping, "GRACE", -1.0)
    scaled, start = noisy_start(nlp.LONG + 1)
    assert nlp.solve(scaled, start).status == "Solve_Succeeded"
    asked = iter([False] + [True] * 1000)  # not before it begins
    with stopping.stopping(lambda: next(asked)):
        solve = nlp.solve(scaled, start)
    assert (solve.status, solve.iterations) == (STOPPED, 0)
    assert np.isfinite(solve.points).all()


def test_no_long_solve_is_begun_after_a_stop() -> None:
    scaled, start = noisy_start(nlp.LONG + 1)
    with stopping.stopping(lambda: True):
        solve = nlp.solve(scaled, start)
        assert (solve.points, solve.status) == ((start.o2, start.o4, start.a, start.b, start.p), STOPPED)
    short, from_there = noisy_start(nlp.LONG)
    with stopping.stopping(lambda: True):
        assert nlp.solve(short, from_there).status == "Solve_Succeeded"


@pytest.mark.filterwarnings("ignore")
def test_an_interrupt_of_a_long_solve_interrupts_the_search(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """CasADi would take it for an answer."""
    scaled, start = noisy_start(nlp.LONG + 1)
    nlp.solve(scaled, start)

    def interrupted(*_: object) -> int:
        raise KeyboardInterrupt

    monkeypatch.setattr(IterationCallback, "eval_buffer", interrupted)
    with pytest.raises(KeyboardInterrupt):
        nlp.solve(scaled, start)
    capfd.readouterr()

"""The columns about made linkages: filled when the problem says how exactly linkages are made."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from grashof.analysis.judge.tolerance import robustness
from grashof.problems import Manufacturing
from grashof.synth import Result

pytestmark = pytest.mark.slow

MANUFACTURING = (
    *("move_r1", "move_r2", "move_r3", "move_r4", "move_u", "move_v"),
    *("worst_move", "share_within_linear", "share_within_made"),
)

MADE = Manufacturing(0.02, band=0.03)


@pytest.fixture(scope="module")
def frame(luggage_result: Result) -> pd.DataFrame:
    problem = replace(luggage_result.problem, manufacturing=MADE)
    return replace(luggage_result, problem=problem).to_frame()


@pytest.mark.study
def test_figures_are_the_analysis(frame: pd.DataFrame, luggage_result: Result) -> None:
    for row, candidate in zip(frame[list(MANUFACTURING)].to_numpy(), luggage_result.candidates, strict=True):
        found = robustness(candidate.linkage, luggage_result.problem.task, candidate.verdict, MADE)
        figures = [*found.moves, found.worst_move, found.share_linear, found.share_made]
        assert row.tolist() == figures


def test_figures_make_sense(frame: pd.DataFrame) -> None:
    moves = frame[list(MANUFACTURING[:6])].to_numpy()
    np.testing.assert_allclose(frame[["move_u", "move_v"]], 1, rtol=1e-12)
    assert (0.02 * moves.max(axis=1) <= frame["worst_move"]).all()
    assert (frame["worst_move"] <= 0.02 * moves.sum(axis=1) * (1 + 1e-12)).all()
    assert frame["share_within_made"].between(0.01, 0.999).all()
    np.testing.assert_allclose(frame["share_within_linear"], frame["share_within_made"], atol=0.02)

"""What a run on a path writes: no angle errors, a driver angle for every point."""

import json
from pathlib import Path

import numpy as np
import pytest

from grashof import load, synthesize
from grashof.analysis import solve_position
from grashof.output.run_files import write_run
from grashof.problems import FourBar


@pytest.mark.slow
def test_designs_of_a_path_have_no_angle_error(tmp_path: Path) -> None:
    result = synthesize(load("path-vertical-line"), starts=8, enough=4)
    files = write_run(tmp_path, result, {}, drawings=1)
    assert {"candidates.csv", "candidates.json", "design-01.png", "design-01.svg"} <= set(files)
    designs = json.loads((tmp_path / "candidates.json").read_text(encoding="utf-8"))["designs"]
    assert len(designs) == len(result)
    for design in designs:
        assert "angle_error" not in design
        gap = solve_position(FourBar(**design["linkage"]), design["theta2"]).p - result.problem.task.positions
        np.testing.assert_allclose(gap, 0, atol=1e-6 * result.problem.task.size)

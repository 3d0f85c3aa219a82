"""The cost curves: the exponent is that of a power, and every axis is measured."""

import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts" / "benchmarks"


def test_the_exponent_is_that_of_a_power(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(SCRIPTS)
    exponent = import_module("benchmark_costs").exponent
    sizes = (4, 40, 400)
    assert exponent(sizes, [3 * size**1.7 for size in sizes]) == pytest.approx(1.7)
    assert exponent(sizes, [0.0, 2.0, 20.0]) == pytest.approx(1.0)
    assert np.isnan(exponent(sizes, [0.0, 0.0, 1.0]))


@pytest.mark.quick("starts-100")
@pytest.mark.slow
@pytest.mark.parametrize(("axis", "most"), [("positions", 40), ("starts", 100), ("list", 100)])
def test_every_axis_is_measured(axis: str, most: int) -> None:
    command = [sys.executable, str(SCRIPTS / "benchmark_costs.py"), "--axis", axis, "--most", str(most)]
    command += ["--kind", "met-poses"]
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    costs = re.findall(rf"^{axis} \S+ (\d+): ([\d.]+) s, \d+ MB$", said, flags=re.MULTILINE)
    assert costs
    assert max(int(size) for size, _ in costs) == most
    assert re.search(
        rf"^{axis} \S+: time grows with the power \S+, memory with \S+$", said, flags=re.MULTILINE
    )

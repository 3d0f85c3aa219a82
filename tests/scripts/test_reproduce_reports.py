"""The tables of the two reports: right figures to the digits of the audit, none of them written down."""

from __future__ import annotations

import ast
import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "reproduce_reports.py"

PUMPJACK = [
    ("omega3 max / min, rad/s", "0.67 / -1.91", "0.724890 / -0.712527"),
    ("alpha3 max / min, rad/s2", "5.08 / -4", "1.322680 / -2.019482"),
    ("v_B max, a_B max", "6.4, 25.1", "2.661607, 7.364377"),
    ("a_B at the ends of the stroke", "0", "7.217 / 4.379"),
    ("v_A, a_A", "2.5, 5", "2.500289, 5.236593"),
    ("rocker swing, deg", "69.2 (from its code)", "46.650006"),
    (
        "system COM at theta2 = 90 deg",
        "(2.92, 3.19)",
        "(1.382152, 4.431897); with the full beam A + C (3.031086, 3.999380)",
    ),
    ("moving mass, kg", "3941.98", "2506.61 for the links simulated; 3942.22 with the full beam"),
]
LUGGAGE = [
    (
        "torque over its 101 samples, max / min / rms",
        "66.48 / -28.90 / 9.48",
        "276.39 / -435.84 / 61.61 (with gravity 348.16 / -399.11 / 69.05)",
    ),
    ("velocities by central differences", "3.6 % low", "-"),
    ("accelerations by central differences", "7.1 % low", "-"),
    ("regression y(x), R2 of degree 2: links 2, 3, 4", '"fits"', "0.592, 0.726, 0.843"),
    ("Newton interpolation, max error: links 2, 3, 4", '"accurate"', "7.58, 24.8, 51.9"),
    ("worst transmission angle, task / turn", "not given", "22.27 / 8.27 deg"),
]


@pytest.fixture(scope="module")
def script() -> ModuleType:
    spec = importlib.util.spec_from_file_location("reproduce_reports", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_both_tables_are_those_of_the_audit(script: ModuleType) -> None:
    assert [row[:3] for row in script.pumpjack()] == PUMPJACK
    rows = script.luggage()
    assert [row[:3] for row in rows] == LUGGAGE
    assert rows[4][3].startswith("same; parametric degree 4: 0.0031, 0.0103, 0.0098 ")
    assert rows[1][3] == "h = 5 deg for samples 4.8194 deg apart"


def test_the_parametric_fit_by_a_second_method(script: ModuleType) -> None:
    """Link 3's figure is not link 4's, as the audit has it: its error is that of the two others added up."""
    fine, off = np.linspace(0, 30, 3001), []
    for track, true in zip(script._tracks(script.ELEVEN), script._tracks(fine), strict=True):
        off.append(np.polynomial.Chebyshev.fit(script.ELEVEN, track[:, 0] + 1j * track[:, 1], 4)(fine))
        off[-1] -= true[:, 0] + 1j * true[:, 1]
    assert [round(float(np.abs(each).max()), 4) for each in off] == [0.0031, 0.0103, 0.0098]
    np.testing.assert_allclose(off[1], off[0] + off[2], rtol=0, atol=1e-12)


def test_no_right_figure_is_written_down() -> None:
    texts = [node.value for node in ast.walk(ast.parse(SCRIPT.read_text())) if isinstance(node, ast.Constant)]
    written = "\n".join(str(text) for text in texts[1:])  # the first explains
    for _, _, right in PUMPJACK + LUGGAGE:
        for figure in right.replace("(", " ").replace(")", " ").replace(",", " ").replace(";", " ").split():
            if "." in figure:
                assert figure not in written, figure


def test_it_prints_them(script: ModuleType, capsys: pytest.CaptureFixture[str]) -> None:
    assert script.main([]) == 0
    said = capsys.readouterr().out
    for quantity, published, right in PUMPJACK + LUGGAGE:
        line = next(line for line in said.splitlines() if quantity in line)
        assert published in line
        assert right in line

"""The plot of a sweep: which one, and that it shows the numbers of the table."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grashof.sweep import Sweep, load_study
from grashof.sweep.combinations import combinations
from grashof.sweep.plot import not_beaten, number_axes, plot_sweep

Write = Callable[..., Path]


@pytest.fixture
def done(write: Write, solved: dict[str, Any]) -> Callable[..., Sweep]:
    """A sweep whose best designs have the transmission angles and sizes given, None where there is none."""

    def of(text: str, values: list[tuple[float, float] | None]) -> Sweep:
        study = load_study(write(f'problem = "base.toml"\n{text}'))
        results = {}
        for number, value in enumerate(values):
            design = dict(solved["designs"][0])
            if value is not None:
                design["transmission_min_task_deg"], design["size"] = value
            found = {"found": 1, "designs": [design]} if value is not None else {"found": 0, "designs": []}
            results[number] = {**solved, **found}
        return Sweep(study, combinations(study), results)

    return of


def test_over_one_number(done: Callable[..., Sweep]) -> None:
    sweep = done("[vary]\n'path.points[1].y' = [3, 1, 2]\n", [(30, 3), (10, 1), None])
    figure = plot_sweep(sweep, sweep.to_frame())
    above, below = figure.axes
    np.testing.assert_array_equal(above.lines[0].get_xydata(), [[1, 10], [2, np.nan], [3, 30]])
    np.testing.assert_array_equal(below.lines[0].get_xydata(), [[1, 1], [2, np.nan], [3, 3]])
    assert above.lines[1].get_xdata().tolist() == [2]
    assert above.get_ylabel() == "worst transmission angle over the task (deg)"
    assert (below.get_xlabel(), below.get_ylabel()) == ("path.points[1].y", "size (mm)")


def test_over_two_numbers(done: Callable[..., Sweep]) -> None:
    text = "[vary]\n'path.points[1].y' = [2, 1]\n'search.seed' = [0, 1, 2]\n"
    sweep = done(text, [(20, 1), (21, 1), None, (10, 1), (11, 1), (12, 1)])
    figure = plot_sweep(sweep, sweep.to_frame())
    grid = np.ma.filled(figure.axes[0].images[0].get_array(), np.nan)
    np.testing.assert_array_equal(grid, [[10, 20], [11, 21], [12, np.nan]])
    assert [text.get_text() for text in figure.axes[0].texts] == ["10", "20", "11", "21", "12", "none"]
    assert [text.get_text() for text in figure.axes[0].get_xticklabels()] == ["1", "2"]


def test_over_words_the_best_designs_against_each_other(done: Callable[..., Sweep]) -> None:
    text = "[vary]\nrequirements.rotatability = ['any', 'full-crank', 'crank-rocker']\n"
    sweep = done(text, [(30, 3), (10, 1), (9, 2)])
    axes = plot_sweep(sweep, sweep.to_frame()).axes[0]
    assert axes.lines[0].get_xydata().tolist() == [[3, 30], [1, 10], [2, 9]]
    assert axes.lines[1].get_xydata().tolist() == [[1, 10], [3, 30]]
    assert [text.get_text() for text in axes.texts] == ["1", "2", "3"]


def test_sizes_in_different_units_are_not_joined(done: Callable[..., Sweep]) -> None:
    sweep = done("[vary]\nrequirements.order = [true, false]\n", [(30, 3), (10, 1)])
    inches = {**sweep.results[1], "decides": {**sweep.results[1]["decides"], "length_unit": "in"}}
    mixed = replace(sweep, results={**sweep.results, 1: inches})
    axes = plot_sweep(mixed, mixed.to_frame()).axes[0]
    assert len(axes.lines) == 1
    assert axes.get_xlabel() == "size"


def test_nothing_found_is_plotted_too(done: Callable[..., Sweep]) -> None:
    for text in ("'path.points[1].y' = [3, 1]\n", "requirements.order = [true, false]\n"):
        sweep = done(f"[vary]\n{text}", [None, None])
        plot_sweep(sweep, sweep.to_frame()).canvas.draw()


@pytest.mark.parametrize(
    ("text", "axes"),
    [
        ("[vary]\nsearch.seed = [1, 2]\n", ("search.seed",)),
        ("[vary]\nsearch.seed = [1]\nsearch.starts = [1, 2]\n", ("search.starts",)),
        (
            "together = [['requirements.order', 'search.seed']]\n"
            "[vary]\nrequirements.order = [true, false]\nsearch.seed = [1, 2]\n",
            ("search.seed",),
        ),
        ("[vary]\nrequirements.order = [true, false]\n", ()),
        ("[vary]\nsearch.seed = [1, 2]\nsearch.starts = [1, 2]\nsearch.enough = [1, 2]\n", ()),
    ],
)
def test_axes_of_the_plot(done: Callable[..., Sweep], text: str, axes: tuple[str, ...]) -> None:
    assert number_axes(done(text, [])) == axes


def test_none_beats_those_that_are_not_beaten() -> None:
    costs = np.random.default_rng(0).integers(0, 5, (40, 2)).astype(float)
    beaten = [any((one <= each).all() and (one < each).any() for one in costs) for each in costs]
    assert (~not_beaten(costs)).tolist() == beaten


def test_the_best_combination(done: Callable[..., Sweep]) -> None:
    sweep = done("[vary]\n'path.points[1].y' = [3, 1, 2]\n", [(30, 3), (40, 1), None])
    assert sweep.best == "path.points[1].y = 1: worst transmission angle over the task (deg) 40"
    assert done("[vary]\nsearch.seed = [3]\n", [None]).best == ""

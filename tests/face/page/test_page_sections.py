"""Sections on the page of an analysis, as text and data: facts, notes, tables, plots, histories."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from page_parts import HOSTILE, RECORD, Parts

import grashof.page
from grashof.figures.section_plots import PENS
from grashof.page.analysis import analysis_page
from grashof.page.plot_data import Columns
from grashof.problems import load_linkage_spec
from grashof.survey import LinkageReport, Plot, Section, report_on


@pytest.fixture(scope="module")
def page(example: LinkageReport) -> Parts:
    return Parts(analysis_page(example, RECORD))


def test_groups_stand_in_order_and_an_empty_section_in_none(page: Parts) -> None:
    titles = [texts[0] for texts in page.groups]
    assert titles[:4] == ["Angles and velocities", "Torque and power", "Forces", "Points A, B and P"]
    assert titles[-3:] == [HOSTILE, "Words alone", "Other axes"]
    assert "Nothing at all" not in titles
    assert len(page.data["groups"]) == len(titles)
    assert page.groups[-2] == ["Words alone", "There is no other."]


def test_facts_and_tables_are_text_with_what_is_not_finite_in_words(page: Parts) -> None:
    texts = page.groups[-3]
    assert texts[:2] == [HOSTILE, "3 plots, 2 tables, 4 values"]
    assert "b" not in page.names
    assert page.names.count("script") == 2
    for label, *rest in (
        [HOSTILE, "=1+1", HOSTILE],
        ["not known", "-", "N"],
        ["without end", "-no limit", "N"],
        ["all bars hold", "yes"],
    ):
        places = [k for k, text in enumerate(texts) if text == label]
        assert rest in [texts[k + 1 : k + 1 + len(rest)] for k in places], label
    cells = texts[texts.index("rank") + 1 :]
    assert cells[:6] == [HOSTILE, "no limit", "1", "b", "0.333333", "2"]


@pytest.mark.slow
def test_every_plot_of_an_analysis_has_a_key_of_its_own() -> None:
    page = Parts(analysis_page(report_on(load_linkage_spec("pumpjack")), RECORD))
    keys = [plot["key"] for group in page.data["groups"] for plot in group]
    assert len(set(keys)) == len(keys) > 30
    assert all(re.fullmatch("[a-z0-9-]+", key) for key in keys)


def test_small_tables_are_shown_and_large_ones_named_with_their_size(page: Parts) -> None:
    names = ("masses", "mass-centres", "few", "many")
    assert page.values("href") == [f"table-{name}.csv" for name in names]
    assert ": 361 rows, 2 columns" in page.groups[-3]


def test_values_that_are_not_finite_are_gaps(page: Parts) -> None:
    known, none = page.plot("gaps")["series"]
    assert np.flatnonzero(np.isnan(page.column(known["values"]))).tolist() == list(range(91, 120))
    assert np.isnan(page.column(none["values"])).all()
    pole = page.plot("hostile")["series"][1]
    assert np.isnan(page.column(pole["values"])[0])
    assert page.plot("hostile")["most"] == pytest.approx(12, rel=0.05)  # the half of both lines is below 1


@pytest.mark.parametrize(
    ("offset", "size"), [(0, 1), (20, 1e-3), (2e6, 0.1), (0, 1e-250), (-3, 1e-7), (1, 1e250)]
)
def test_columns_are_as_fine_as_one_can_see(offset: float, size: float) -> None:
    values = offset + size * np.sin(np.linspace(0, 6, 361))
    columns = Columns()
    columns.add(values)
    np.testing.assert_allclose(np.array(columns.found[0], dtype=float), values, rtol=0, atol=1e-3 * size)


def test_columns_are_short_where_they_are_nothing_but_rounding() -> None:
    columns = Columns()
    random = np.random.default_rng(0)
    columns.add(2.5 + 1e-15 * random.normal(size=361))
    columns.add(np.where(np.arange(361) % 2, 1e-17, 1.0))
    assert columns.found == [[2.5] * 361, [1.0, 0.0] * 180 + [1.0]]


def test_columns_are_kept_once(page: Parts) -> None:
    columns = [tuple(column) for column in page.data["columns"]]
    assert len(columns) == len(set(columns))
    over_angle = {
        plot["places"]
        for group in page.data["groups"]
        for plot in group
        if "places" in plot and "over" not in plot
    }
    assert len(over_angle) == 1


@pytest.mark.parametrize("seed", range(3))
def test_a_long_history_keeps_its_shape(example: LinkageReport, seed: int) -> None:
    """Between the rows that the page has, no value leaves those at its ends by more than can be seen."""
    random = np.random.default_rng(seed)
    time = np.linspace(0, 20, 20001)
    smooth = np.cumsum(np.cumsum(random.normal(size=20001)))
    smooth[5000:5010] = np.nan
    spiked = np.where(np.arange(20001) == random.integers(20001), 5.0, np.sin(time))
    plot = Plot("long", "long", "m", {"smooth": smooth, "spiked": spiked}, time, "time (s)")
    section = Section("long", "Long", plots=(plot,))
    page = Parts(analysis_page(replace(example, sections=(section,)), RECORD))
    shown = page.plot("long")
    assert any("only some of their samples" in text for text in page.groups[-1])
    places = page.column(shown["places"])
    assert 500 < len(places) <= 1600
    for line, values in zip(shown["series"], (smooth, spiked), strict=True):
        kept = page.column(line["values"])
        assert np.nanmax(kept) == pytest.approx(np.nanmax(values), rel=1e-4)
        assert np.nanmin(kept) == pytest.approx(np.nanmin(values), rel=1e-4)
    assert np.isnan(page.column(shown["series"][0]["values"])).sum() == 10
    drawn = np.interp(time, places, page.column(shown["series"][0]["values"]))
    known = np.isfinite(drawn) & np.isfinite(smooth)
    assert np.abs(drawn - smooth)[known].max() < 0.01 * np.ptp(smooth[known])


def test_a_page_with_a_hundred_plots_is_below_a_megabyte(example: LinkageReport) -> None:
    theta2 = np.arange(361.0)
    turn = np.radians(theta2)
    plots = [
        Plot(f"p-{k}", f"plot {k}", "N", {f"{n}": np.sin(turn * (k + n)) for n in range(3)}, theta2)
        for k in range(1, 101)
    ]
    page = analysis_page(replace(example, sections=(Section("s", "S", plots=tuple(plots)),)), RECORD)
    assert len(page.encode()) < 1_500_000


def test_pens_are_those_of_the_figures() -> None:
    style = (Path(grashof.page.__file__).parent / "templates" / "page.css").read_text(encoding="utf-8")
    colours = dict(re.findall(r"--([\w-]+): (#\w+)", style.partition("@media")[0]))
    dashes = {
        pen: tuple(map(int, dash.split()))
        for pens, dash in re.findall(
            r"^((?:\.curve\.pen-\d,? ?)+)\{ stroke-dasharray: ([\d ]+);", style, re.MULTILINE
        )
        for pen in re.findall(r"pen-\d", pens)
    }
    for number, (colour, dash) in enumerate(PENS, start=1):
        name = re.search(rf"\.pen-{number} {{ --pen: var\(--([\w-]+)\)", style)
        assert name is not None
        assert (colours[name[1]], dashes.get(f"pen-{number}", ())) == (colour, dash)


def test_tables_of_numpy_values_are_written(example: LinkageReport) -> None:
    table = pd.DataFrame(
        {"flag": np.array([True, False]), "count": np.array([3, 12345678]), "x": [np.nan, 1e-9]}
    )
    page = Parts(analysis_page(replace(example, sections=(Section("t", "T", tables={"t": table}),)), RECORD))
    assert page.groups[-1][-6:] == ["yes", "3", "-", "no", "12345678", "1e-09"]

"""The linkages of the catalogue are those of their sources."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grashof.problems import (
    InvertedSliderCrank,
    Linkage,
    SixBar,
    SliderCrank,
    linkage_catalogue,
    load_linkage,
    load_linkage_spec,
)

ROOT = Path(__file__).parents[3]
GOLDEN = json.loads((ROOT / "tests" / "data" / "golden.json").read_text())


def test_catalogue_is_what_is_shipped() -> None:
    shipped = {path.stem for path in (ROOT / "problems" / "data" / "linkages").glob("*.toml")}
    assert set(linkage_catalogue()) == shipped
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    assert {"data/linkages/*.toml", "data/practice/*.toml"} <= set(settings["package-data"]["*"])


def test_pumpjack_is_that_of_the_report() -> None:
    golden, spec = GOLDEN["pumpjack_report_geometry"], load_linkage_spec("pumpjack")
    r3 = float(golden["inputs"]["r3"])
    assert spec.linkage.lengths.tolist() == [5.0, 1.1938, r3, 3.048762]
    assert complex(*spec.linkage.coupler_point) == pytest.approx(r3 / 2 * np.exp(0.4j), rel=1e-15)
    assert spec.dynamics is not None
    given = golden["inverse_dynamics"]
    np.testing.assert_allclose(spec.dynamics.masses, np.array(given["masses"], dtype=float), rtol=1e-14)
    np.testing.assert_allclose(spec.dynamics.inertias, np.array(given["inertias"], dtype=float), rtol=1e-14)


def test_real_unit_is_that_of_its_maker() -> None:
    golden = GOLDEN["pumpjack_lufkin_C912D_427_144"]
    spec, given = load_linkage_spec("lufkin-c912d"), golden["inputs_in"]
    assert float(spec.linkage.r1) == pytest.approx(float(golden["K_in"]), rel=1e-14)
    assert [float(given[key]) for key in "RPC"] == spec.linkage.lengths[1:].tolist()
    assert spec.output_arm == float(given["A"])


def test_the_sliders_of_the_catalogue() -> None:
    engine, shaper = load_linkage("engine"), load_linkage("crank-shaper")
    assert isinstance(engine, SliderCrank)
    assert (float(engine.r2), float(engine.r3), float(engine.offset)) == (40, 120, -20)
    assert isinstance(shaper, InvertedSliderCrank)
    assert float(shaper.r2 / shaper.r1) == pytest.approx(np.sin(np.radians(60 / 2)), rel=1e-15)


def meeting(p: Any, r: float, q: Any, s: float, side: int) -> Any:
    """The point at r from p and at s from q, on the left of p -> q (+1) or on its right."""
    way = q - p
    along = (abs(way) ** 2 + r**2 - s**2) / (2 * abs(way))
    return p + (along + 1j * side * np.sqrt(r**2 - along**2)) * way / abs(way)


TURN = np.exp(2j * np.pi * np.arange(3600) / 3600)


def carried_point(linkage: Linkage) -> tuple[Any, Any, Any]:
    """C, E and P of a Stephenson III of the catalogue over a turn, by two meetings of circles."""
    assert isinstance(linkage, SixBar)
    o2, o4, c, d, p = (complex(*getattr(linkage, x)) for x in ("o2", "o4", "c", "d", "coupler_point"))
    a = o2 + float(linkage.r2) * TURN
    b = meeting(a, float(linkage.r3), o4, float(linkage.r4), int(linkage.assembly))
    at_c = a + c * (b - a) / float(linkage.r3)
    e = meeting(at_c, float(linkage.r5), d, float(linkage.r6), int(linkage.assembly_2))
    return at_c, e, at_c + p * (e - at_c) / float(linkage.r5)


def test_klanns_leg_is_that_of_the_patent() -> None:
    leg = load_linkage("klann")
    assert isinstance(leg, SixBar)
    r3, c, foot = float(leg.r3), complex(*leg.c), complex(*leg.coupler_point)
    assert [abs(c), abs(c - r3)] == pytest.approx([1.1051, 0.5221], rel=1e-12)  # 35 from 29 and from 27
    assert [abs(foot), abs(foot - float(leg.r5))] == pytest.approx([0.8966, 1.732], rel=1e-12)
    _, _, way = carried_point(leg)
    assert np.ptp(way.real) == pytest.approx(1.0087, abs=5e-5)
    assert np.ptp(way.imag) == pytest.approx(0.5273, abs=5e-5)
    assert np.mean(way.imag < way.imag.min() + 0.02 * np.ptp(way.imag)) == pytest.approx(0.085, abs=1e-3)


def test_the_dwell_of_the_course_project() -> None:
    linkage = load_linkage("dwell-six-bar")
    assert abs(complex(*linkage.c)) == pytest.approx(62.89)  # type: ignore[attr-defined]
    assert np.degrees(np.angle(complex(*linkage.c))) == pytest.approx(21.89)  # type: ignore[attr-defined]
    _, e, _ = carried_point(linkage)
    theta6 = np.degrees(np.unwrap(np.angle(e - complex(*linkage.d))))  # type: ignore[attr-defined]
    assert np.ptp(theta6) == pytest.approx(15.83, abs=5e-3)
    turns = np.concatenate([theta6, theta6])
    spans = np.lib.stride_tricks.sliding_window_view(turns, 1386)  # steps of 0.1 deg, 138.5 deg long
    assert 0.498 < np.ptp(spans, axis=1).min() < 0.5

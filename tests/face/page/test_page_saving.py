"""Files saved from pages: pictures that stand alone as SVG and PNG, CSV with the numbers of the report."""

# ruff: noqa: S314

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
from page_parts import HOSTILE
from PIL import Image
from shown_pages import Open

from grashof.survey import LinkageReport
from grashof.synth import Result

if TYPE_CHECKING:
    from playwright.sync_api import Page

SVG = "{http://www.w3.org/2000/svg}"


def saved(page: Page, title: str, kind: str, folder: Path) -> Path:
    """The file that a button of a plot writes, under the offered name."""
    with page.expect_download() as found:
        page.get_by_label(f"Save {title} as {kind}", exact=True).click()
    path = folder / found.value.suggested_filename
    found.value.save_as(path)
    return path


def opened_wide(opened: Open, name: str, **media: Any) -> Page:
    page = opened(name, size=(1440, 900), **media)
    page.locator("#open-all").click()
    page.locator("figure.plot").last.wait_for()
    return page


def lines_of(path: Path) -> list[np.ndarray]:
    """Corners of every curve of a saved plot in px; NaN where it is lifted."""
    found = []
    for node in ET.parse(path).getroot().findall(f"{SVG}path"):
        if "transform" in node.attrib:  # of the legend, or a single point
            continue
        pieces = [
            np.array([corner.split() for corner in piece.split("L")], dtype=float)
            for piece in node.attrib["d"].split("M")[1:]
        ]
        gap = np.full((1, 2), np.nan)
        found.append(np.concatenate([part for piece in pieces for part in (piece, gap)] or [gap]))
    return found


def scales_of(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Of both axes, slope and origin from px to numbers, out of the numbers that stand there."""
    across, up = [], []
    (grid,) = ET.parse(path).getroot().findall(f"{SVG}g")
    for text in grid.findall(f"{SVG}text"):
        value = float((text.text or "").replace("−", "-"))
        if text.attrib["text-anchor"] == "middle":
            across.append((float(text.attrib["x"]), value))
        else:
            up.append((float(text.attrib["y"]) - 4, value))
    return tuple(np.polyfit(*np.array(pairs).T, 1) for pairs in (across, up))  # type: ignore[return-value]


def assert_stands_alone(root: ET.Element) -> tuple[float, float]:
    """A picture on white that needs no style sheet; its width and height."""
    width, height = float(root.attrib["width"]), float(root.attrib["height"])
    assert root[0].attrib == {"width": f"{width:g}", "height": f"{height:g}", "fill": "#ffffff"}
    for node in root.iter():
        assert not {"class", "style", "href", "id", "role", "tabindex", "data-index"} & set(node.attrib)
    return width, height


def test_saved_pictures_have_the_curves_of_the_report_and_stand_alone_on_white(
    opened: Open, example: LinkageReport, tmp_path: Path
) -> None:
    page = opened_wide(opened, "sections", color_scheme="dark")
    path = saved(page, "angles", "SVG", tmp_path)
    assert path.name == "pumpjack-angles.svg"
    across, up = scales_of(path)
    table = example.tables["kinematics"]
    lines = lines_of(path)
    assert len(lines) == 3
    for line, key in zip(lines, ("theta3_deg", "theta4_deg", "mu_deg"), strict=True):
        places, values = np.polyval(across, line[:, 0]), np.polyval(up, line[:, 1])
        known = np.isfinite(places)
        np.testing.assert_allclose(places[known], table["theta2_deg"], atol=0.05)
        np.testing.assert_allclose(values[known], table[key], atol=0.05)

    path = saved(page, "joint forces", "SVG", tmp_path)
    root = ET.parse(path).getroot()
    assert root.tag == f"{SVG}svg"
    width, height = assert_stands_alone(root)
    assert root.attrib["viewBox"] == f"0 0 {width:g} {height:g}"
    words = [node.text for node in root.iter(f"{SVG}text")]
    for expected in ("joint forces", "joint forces (N)", "driver angle theta2 (deg)", "A", "O4"):
        assert expected in words
    for node in root.iter():
        assert node.tag in {f"{SVG}{name}" for name in ("svg", "g", "path", "text", "rect")}
        if node.tag == f"{SVG}text":
            assert {"fill", "font-size"} <= set(node.attrib)
    curves = [node.attrib for node in root.findall(f"{SVG}path") if "transform" not in node.attrib]
    assert curves[0]["stroke"] == "rgb(0, 114, 178)"  # of the light page
    assert [curve.get("stroke-dasharray") for curve in curves] == [None, "7, 3", None, "3, 3"]
    assert {curve["fill"] for curve in curves} == {"none"}
    for corners in lines_of(path):
        assert (np.nanmin(corners, axis=0) >= 0).all()
        assert (np.nanmax(corners, axis=0) <= (width, height)).all()


def test_saved_tables_have_the_numbers_of_the_report(
    opened: Open, example: LinkageReport, tmp_path: Path
) -> None:
    page = opened_wide(opened, "sections")
    forces = saved(page, "joint forces", "CSV", tmp_path)
    assert forces.name == "pumpjack-joint-forces.csv"
    table, dynamics = pd.read_csv(forces), example.tables["dynamics"]
    assert table.columns.tolist() == [
        "driver angle theta2 (deg)", "joint forces, O2 (N)", "joint forces, A (N)", "joint forces, B (N)",
        "joint forces, O4 (N)",
    ]  # fmt: skip
    columns = dynamics[["theta2_deg", "f12", "f32", "f43", "f14"]]
    np.testing.assert_allclose(table.to_numpy(), columns.to_numpy(), rtol=5e-5)
    run = pd.read_csv(saved(page, "run-out", "CSV", tmp_path))
    assert run.columns.tolist() == ["time (s)", "run-out, theta2 (deg)", "run-out, slow (deg)"]
    np.testing.assert_allclose(run.iloc[:, 1], 10 * run.iloc[:, 0], rtol=5e-5)
    track = pd.read_csv(saved(page, "track", "CSV", tmp_path))
    assert track.columns.tolist() == [
        "driver angle theta2 (deg)", "track, P, x (m/s)", "track, P, y (m/s)", "90, x (m/s)", "90, y (m/s)",
    ]  # fmt: skip
    angle = np.radians(track.iloc[:, 0])
    np.testing.assert_allclose(track.iloc[:, 1], 3 * np.cos(angle), atol=1e-4)
    assert track.iloc[0, 4] == 2
    assert track.iloc[1:, 3:].isna().all(axis=None)
    still = pd.read_csv(saved(page, "no angles", "CSV", tmp_path))
    assert still.notna().sum().tolist() == [361, 361, 7, 7]
    motor = pd.read_csv(saved(page, "motor", "CSV", tmp_path))
    assert motor.columns.tolist() == ["driver angle theta2 (deg)", "speed", "motor, T (N m)"]

    root = ET.parse(saved(page, HOSTILE, "SVG", tmp_path)).getroot()
    assert HOSTILE in [node.text for node in root.iter(f"{SVG}text")]
    assert {str(node.tag).removeprefix(SVG) for node in root.iter()} == {"svg", "g", "path", "text", "rect"}
    table = pd.read_csv(saved(page, HOSTILE, "CSV", tmp_path))
    title = HOSTILE.replace("; -2", ";' -2")
    assert table.columns[1] == f"{title}, {title} ({title})"
    assert len(table) == 361
    assert np.isnan(table.iloc[0, 2])


def test_a_swinging_driver_saves_the_window_and_all_of_the_table(
    opened: Open, swinging: LinkageReport, tmp_path: Path
) -> None:
    page = opened_wide(opened, "swinging")
    page.locator("#range").select_option("1")
    path = saved(page, "angular velocity", "SVG", tmp_path)
    assert path.name == "double-rocker-angular-velocity.svg"
    across, _ = scales_of(path)
    low, high = np.degrees(swinging.sweep.ranges[1])
    for line in lines_of(path):
        places = np.polyval(across, line[:, 0])
        assert low - 0.1 <= np.nanmin(places) < np.nanmax(places) <= high + 0.1
    table = pd.read_csv(saved(page, "angular velocity", "CSV", tmp_path), skip_blank_lines=False)
    rows = swinging.tables["kinematics"]
    assert table.iloc[:, 0].notna().sum() == len(rows) == 722
    assert table.iloc[361].isna().all()
    kept = table.drop(index=361).to_numpy()
    np.testing.assert_allclose(kept, rows[["theta2_deg", "omega3", "omega4"]], rtol=5e-5, atol=1e-9)


def test_any_plot_is_saved_and_every_file_has_its_own_name(opened: Open, tmp_path: Path) -> None:
    page = opened_wide(opened, "sections")
    keys = page.evaluate(
        "JSON.parse(document.querySelector('#data').textContent).groups.flat().map((p) => p.key)"
    )
    assert len(set(keys)) == len(keys) == 46
    names = set()
    for button in page.locator(".save button").all()[-8:]:  # of the last plots; Chromium allows ten a second
        with page.expect_download() as found:
            button.click()
        path = tmp_path / found.value.suggested_filename
        found.value.save_as(path)
        names.add(path.name)
        if path.suffix == ".svg":
            text = path.read_text(encoding="utf-8")
            assert not re.search(r"NaN|Infinity|undefined|null", text)
            ET.fromstring(text)
        else:
            assert len(pd.read_csv(path)) > 5
    assert len(names) == 8


def test_pictures_of_a_search_stand_alone_on_white(opened: Open, few: Result, tmp_path: Path) -> None:
    page = opened("search", size=(1440, 900), color_scheme="dark")
    for title in ("transmission angle", "torque", "comparison", "drawing"):
        root = ET.parse(saved(page, title, "SVG", tmp_path)).getroot()
        width, height = assert_stands_alone(root)
        strokes = {node.attrib.get("stroke") for node in root.iter()}
        assert "rgb(0, 114, 178)" in strokes  # of the light page
        if title == "comparison":
            assert len(list(root.iter(f"{SVG}circle"))) == len(few)
            words = [node.text for node in root.iter(f"{SVG}text")]
            assert {"μ task against size", "μ task (deg)", "size (m)"} <= set(words)
    picture = Image.open(saved(page, title, "PNG", tmp_path))
    assert picture.size == (2 * width, 2 * height)
    colours = picture.convert("RGB").getcolors(1 << 24)
    assert colours is not None
    assert max(colours)[1] == (255, 255, 255)
    assert (0, 114, 178) in {colour for _, colour in colours}
    assert page.locator(".sheet").count() == 0


def test_curves_have_the_numbers_of_the_design(opened: Open, few: Result, tmp_path: Path) -> None:
    page = opened("search", size=(1440, 900))
    page.locator("#designs [data-pick]").nth(2).click()
    path = saved(page, "transmission angle", "CSV", tmp_path)
    assert path.name == f"{few.problem.name}-design-3-transmission.csv"
    table = pd.read_csv(path)
    assert table.columns[0] == "driver angle theta2 (deg)"
    worst = np.degrees(few.candidates[2].verdict.transmission_min_cycle)
    assert worst - 1e-9 <= table.iloc[:, 1].min() <= worst + 0.1


def test_the_list_is_saved_as_it_is_shown(opened: Open, few: Result, tmp_path: Path) -> None:
    page, frame = opened("search"), few.to_frame()
    page.locator("th[data-key=size] button").click()
    page.check("[name=pareto]")
    path = saved(page, "table", "CSV", tmp_path)
    assert path.name == f"{few.problem.name}-designs.csv"
    table = pd.read_csv(path, encoding="utf-8-sig")
    wanted = frame[frame["pareto"]].sort_values("size")
    assert table["id"].tolist() == wanted["id"].tolist()
    assert table["size (m)"].tolist() == wanted["size"].tolist()
    assert table["Grashof class"].tolist() == wanted["grashof_class"].tolist()

"""Files saved from the page of a search: plots and the drawing as SVG and PNG, the list as CSV."""

# ruff: noqa: S314

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pytest
from PIL import Image
from playwright.sync_api import Page

from grashof.synth import Result

Open = Callable[..., Page]
SVG = "{http://www.w3.org/2000/svg}"


def saved(page: Page, title: str, kind: str, folder: Path) -> Path:
    with page.expect_download() as found:
        page.get_by_label(f"Save {title} as {kind}", exact=True).click()
    path = folder / found.value.suggested_filename
    found.value.save_as(path)
    return path


@pytest.mark.parametrize("title", ["transmission angle", "torque", "comparison", "drawing"])
def test_pictures_stand_alone_on_white(opened: Open, tmp_path: Path, title: str) -> None:
    page = opened("search", size=(1440, 900), color_scheme="dark")
    path = saved(page, title, "SVG", tmp_path)
    root = ET.parse(path).getroot()
    width, height = float(root.attrib["width"]), float(root.attrib["height"])
    assert root[0].attrib == {"width": f"{width:g}", "height": f"{height:g}", "fill": "#ffffff"}
    for node in root.iter():
        assert not {"class", "style", "href", "id", "role", "tabindex", "data-index"} & set(node.attrib)
    strokes = {node.attrib.get("stroke") for node in root.iter()}
    assert "rgb(0, 114, 178)" in strokes  # of the light page in the dark, too
    picture = Image.open(saved(page, title, "PNG", tmp_path))
    assert picture.size == (2 * width, 2 * height)
    colours = picture.convert("RGB").getcolors(1 << 24)
    assert colours is not None
    assert max(colours)[1] == (255, 255, 255)
    assert (0, 114, 178) in {colour for _, colour in colours}
    assert page.locator(".sheet").count() == 0


def test_a_comparison_has_every_design(opened: Open, few: Result, tmp_path: Path) -> None:
    page = opened("search", size=(1440, 900))
    root = ET.parse(saved(page, "comparison", "SVG", tmp_path)).getroot()
    assert len(list(root.iter(f"{SVG}circle"))) == len(few)
    words = [node.text for node in root.iter(f"{SVG}text")]
    assert {"μ task against size", "μ task (deg)", "size (m)"} <= set(words)


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

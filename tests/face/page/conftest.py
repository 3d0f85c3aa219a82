"""Pages in a real browser, as a user has them, from the disk; all in one window."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
import pytest
from page_parts import HOSTILE, MISSES, RECORD, ROCKER, TITLE, placed_lid
from shown_pages import Open, without_complaints

from grashof import load, synthesize
from grashof.page.analysis import analysis_page
from grashof.page.search import search_page
from grashof.problems import FourBar, LinkageSpec, load_linkage_spec
from grashof.survey import Fact, LinkageReport, Plot, Section, report_on
from grashof.synth import Result
from grashof.synth.designs.table import rows_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page, Request

PagePath = Callable[[str], Path]
# Its driver just turns; within one degree P moves a fifth of its path.
NEARLY_DEAD = FourBar((0, 0), (1.38, 0), 1.43, 1.7, 1.74, (1, 1))
WAYS = "no design; each of these alone would do: order = false; transmission_min_deg 13 instead of 60"
AS_USUAL: dict[str, Any] = {"media": "screen", "color_scheme": "light", "reduced_motion": "no-preference"}


def example_sections() -> tuple[Section, ...]:
    """Sections with all that a section may have, and with what none should have."""
    theta2 = np.arange(361.0)
    turn, time = np.radians(theta2), np.linspace(0, 12, 4001)
    round_trip = np.column_stack([3 * np.cos(turn), 2 * np.sin(turn)])
    gaps = np.where((theta2 > 90) & (theta2 < 120), np.nan, np.sin(turn))
    pole = np.where(theta2 == 0, np.inf, 1 / np.sin(turn + 1e-9))
    along, top = np.linspace(0, 4, 41), {"90": round_trip[90:91]}
    return (
        Section(
            "all",
            HOSTILE,
            (
                Fact("mass", HOSTILE, "=1+1", HOSTILE),
                Fact("unknown", "not known", np.nan, "N"),
                Fact("endless", "without end", -np.inf, "N"),
                Fact("holds", "all bars hold", True),
            ),
            {
                "few": pd.DataFrame({"name": [HOSTILE, "b"], "value": [np.inf, 1 / 3], "rank": [1, 2]}),
                "many": pd.DataFrame({"theta2_deg": theta2, "value": gaps}),
            },
            (
                Plot("hostile", HOSTILE, HOSTILE, {HOSTILE: np.sin(turn), "_": pole}, theta2),
                Plot("gaps", "with gaps", "N", {"known": gaps, "none": np.full(361, np.nan)}, theta2),
                Plot("error", "small angle", "deg", {"error": 20 + 1e-6 * np.sin(turn)}, theta2),
            ),
            (HOSTILE,),
        ),
        Section("none", "Nothing at all"),
        Section("words", "Words alone", notes=("there is no other",)),
        Section(
            "other",
            "Other axes",
            plots=(
                Plot("run", "run-out", "deg", {"theta2": 10 * time, "slow": time}, time, "time (s)"),
                Plot("sag", "sag", "m", {f"{k}": np.sin(along + k) for k in range(12)}, along, "along (m)"),
                Plot("motor", "motor", "N m", {"T": np.sin(2 * turn)}, np.cos(turn), "speed", angles=theta2),
                Plot("track", "track", "m/s", {"P": round_trip}, angles=theta2, points=top),
                Plot("still", "no angles", "m", {"a": round_trip, "b": round_trip[:7] * 2}),
            ),
        ),
    )  # fmt: skip


@pytest.fixture(scope="package")
def example() -> LinkageReport:
    report = report_on(load_linkage_spec("pumpjack"))
    own = [section for section in report.sections if section.key == "mass-centres"]
    return replace(report, sections=(*own, *example_sections()))


@pytest.fixture(scope="package")
def swinging() -> LinkageReport:
    """A driver that swings in two ranges, the second of which lies below the first."""
    return report_on(
        LinkageSpec(FourBar((0, 0), (4, 0), 3, 1, 3, (0.5, 1)), "double rocker", length_unit="mm")
    )


@pytest.fixture(scope="package")
def inexact() -> Result:
    """Designs by least squares, whose errors differ."""
    return synthesize(load("path-gait"), starts=5)


@pytest.fixture(scope="package")
def flaps() -> Result:
    """Designs with struts, each a family of its own."""
    found = synthesize(load("kitchen-flap"), starts=6, enough=2)
    return replace(found, candidates=tuple(replace(each, family=each.id) for each in found.candidates))


@pytest.fixture(scope="package")
def page_path(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> PagePath:
    """The file of a page by its name, made when it is first opened."""
    folder, shared = tmp_path_factory.mktemp("pages"), request.getfixturevalue

    def search(**changes: Any) -> str:
        few: Result = shared("few")
        missing = [rows_of(few.problem, few.candidates[:1])[0] | {"misses": MISSES}]
        missed = replace(few, candidates=(), nearest=few.candidates[:1], note=f"no design: {MISSES}")
        rows = None if "nearest" in changes else missing
        return search_page(replace(missed, **changes), RECORD, rows=rows)

    def named() -> str:
        few: Result = shared("few")
        rows = rows_of(few.problem, few.candidates)
        return search_page(replace(few, problem=replace(few.problem, title=TITLE)), RECORD, "kind", rows=rows)

    def design() -> str:
        few: Result = shared("few")
        spec = LinkageSpec(few.candidates[0].linkage, "design", length_unit="m", problem=few.problem)
        return analysis_page(report_on(spec), RECORD)

    makers: dict[str, Callable[[], str]] = {
        "search": named,
        "alike": lambda: search_page(shared("alike"), RECORD),
        "inexact": lambda: search_page(shared("inexact"), RECORD),
        "flaps": lambda: search_page(shared("flaps"), RECORD),
        "missed": search,
        "relaxed": lambda: search(note=WAYS),
        "nothing": lambda: search(nearest=()),
        "design": design,
        "rocker": lambda: analysis_page(report_on(LinkageSpec(ROCKER, "rocker", title=TITLE)), RECORD),
        "lid": lambda: analysis_page(report_on(placed_lid()), RECORD),
        "swift": lambda: analysis_page(report_on(LinkageSpec(NEARLY_DEAD, "swift")), RECORD),
        "sections": lambda: analysis_page(shared("example"), RECORD),
        "swinging": lambda: analysis_page(shared("swinging"), RECORD),
    }

    def path_of(name: str) -> Path:
        path = folder / f"{name}.html"
        if not path.exists():
            path.write_text(makers[name](), encoding="utf-8")
        return path

    return path_of


@pytest.fixture(scope="package")
def window(browser: Browser) -> Page:
    """One for all tests: to open another takes longer than most of them."""
    return browser.new_page()


@pytest.fixture(scope="package")
def telephone(browser: Browser) -> Page:
    return browser.new_page(viewport={"width": 360, "height": 740}, has_touch=True, is_mobile=True)


@pytest.fixture
def opened(window: Page, telephone: Page, page_path: PagePath) -> Iterator[Open]:
    """Opens a page; at the end the console is empty and nothing was requested over a network."""
    asked: list[str] = []
    addresses: list[str] = []

    def note(request: Request) -> None:
        asked.append(request.url)

    for shown in (window, telephone):
        shown.on("request", note)

    def open_page(name: str, size: tuple[int, int] = (1280, 720), touch: bool = False, **media: Any) -> Page:
        page = telephone if touch else window
        if not touch:
            page.set_viewport_size({"width": size[0], "height": size[1]})
            page.mouse.move(0, 0)
            page.emulate_media(**AS_USUAL | media)
        addresses.append(page_path(name).as_uri())
        page.goto(addresses[-1])
        return page

    with without_complaints(window, telephone):
        yield open_page
    for shown in (window, telephone):
        shown.remove_listener("request", note)
    assert asked == addresses

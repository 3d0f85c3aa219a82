"""Pages in a real browser, as a user has them, from the disk; one browser and one window for all of them."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from grashof.page import analysis_page, search_page
from grashof.problems import FourBar, LinkageSpec
from grashof.survey import report_on
from grashof.synth import Result

Open = Callable[..., Page]
RECORD: dict[str, Any] = {"versions": {"grashof": "0"}, "settings": {"seed": 0}}
TITLE = "<script>document.title = 'caught'</script>"
ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
# Its driver just turns; in one degree P moves a fifth of its whole way.
NEARLY_DEAD = FourBar((0, 0), (1.38, 0), 1.43, 1.7, 1.74, (1, 1))
# As long as a search may say it, and a word that is too long for any line.
MISSES = "transmission_min_deg: the worst transmission angle over the turn in deg is 13.4955, allowed: "
MISSES += f"from 60; constraints: {'a_long_name_' * 20} is 3, allowed: up to 0"
AS_USUAL: dict[str, Any] = {"media": "screen", "color_scheme": "light", "reduced_motion": "no-preference"}


@pytest.fixture(scope="package")
def title() -> str:
    return TITLE


@pytest.fixture(scope="package")
def misses() -> str:
    return MISSES


@pytest.fixture(scope="package")
def rocker() -> FourBar:
    return ROCKER


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
    path = next((name for name in found if name), None)
    if path is None:
        pytest.skip("no Chromium on this machine: the page is not tested in a browser")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="package")
def folder(few: Result, alike: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pages of searches, with families and without, in vain, and of a driver that cannot turn fully."""
    path = tmp_path_factory.mktemp("pages")
    named = replace(few, problem=replace(few.problem, title=TITLE))
    frame = few.to_frame()
    missed = replace(few, candidates=(), nearest=few.candidates[:1], note=f"no design: {MISSES}")
    pages = {
        "search": search_page(named, frame, RECORD, "kind"),
        "alike": search_page(alike, alike.to_frame(), RECORD),
        "missed": search_page(missed, frame.iloc[:1].assign(misses=MISSES), RECORD),
        "nothing": search_page(replace(missed, nearest=()), frame.iloc[:0], RECORD),
        "rocker": analysis_page(report_on(LinkageSpec(ROCKER, "rocker", title=TITLE)), RECORD),
        "swift": analysis_page(report_on(LinkageSpec(NEARLY_DEAD, "swift")), RECORD),
    }
    for name, page in pages.items():
        (path / f"{name}.html").write_text(page, encoding="utf-8")
    return path


@pytest.fixture(scope="package")
def window(browser: Browser) -> Page:
    """One for all tests: to open another takes longer than most of them."""
    return browser.new_page()


@pytest.fixture(scope="package")
def telephone(browser: Browser) -> Page:
    return browser.new_page(viewport={"width": 360, "height": 740}, has_touch=True, is_mobile=True)


@pytest.fixture
def opened(window: Page, telephone: Page, folder: Path) -> Iterator[Open]:
    """Opens a page; at the end nothing may have been complained of or asked for over a network."""
    complaints: list[str] = []
    asked: list[str] = []
    addresses: list[str] = []
    listeners: dict[Any, Callable[[Any], None]] = {
        "console": lambda message: complaints.append(f"{message.type}: {message.text}"),
        "pageerror": lambda error: complaints.append(str(error)),
        "request": lambda request: asked.append(request.url),
    }
    for shown in (window, telephone):
        for event, listener in listeners.items():
            shown.on(event, listener)

    def open_page(name: str, size: tuple[int, int] = (1280, 720), touch: bool = False, **media: Any) -> Page:
        page = telephone if touch else window
        if not touch:
            page.set_viewport_size({"width": size[0], "height": size[1]})
            page.mouse.move(0, 0)
            page.emulate_media(**AS_USUAL | media)
        addresses.append((folder / f"{name}.html").as_uri())
        page.goto(addresses[-1])
        return page

    yield open_page
    for shown in (window, telephone):
        for event, listener in listeners.items():
            shown.remove_listener(event, listener)
    assert complaints == []
    assert asked == addresses

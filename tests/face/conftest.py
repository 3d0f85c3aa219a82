from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from command_runs import Grashof
from typer.testing import CliRunner

import grashof.output.drawing as grashof_drawing
from grashof import load, synthesize
from grashof.cli import app
from grashof.problems import problem_text
from grashof.synth import Result

if TYPE_CHECKING:
    from playwright.sync_api import Browser


@pytest.fixture(autouse=True)
def _no_figures_left() -> Iterator[None]:
    """Figures that a test opens are closed after it."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def grashof(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Grashof:
    """The command, run in an empty folder, all of it in this process."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(grashof_drawing, "_may_be_copied", lambda: False)
    runner = CliRunner()
    return lambda *arguments: runner.invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def refused(grashof: Grashof) -> Callable[..., str]:
    """The line on stderr, and the only one, with which the command refuses its arguments."""

    def line(*arguments: Any) -> str:
        done = grashof(*arguments)
        assert (done.exit_code, done.stderr.count("\n")) == (2, 1), done.output
        return str(done.stderr)

    return line


@pytest.fixture(scope="session")
def few() -> Result:
    """Eight designs for the luggage problem, each a family of its own and none of them doubted; no proof."""
    found = synthesize(load("luggage"), enough=12, starts=9)
    each = tuple(replace(c, family=c.id, caution="") for c in found.candidates)
    return replace(found, candidates=each, proof=None)


@pytest.fixture
def found_at_once(few: Result, monkeypatch: pytest.MonkeyPatch) -> None:
    """Any search of `grashof solve` finds `few` without solving."""
    monkeypatch.setattr("grashof.synth.synthesize", lambda *_, **__: few)


@pytest.fixture(scope="session")
def proven() -> Result:
    """Three designs or so for the luggage problem, with the proof that the first is the best."""
    return synthesize(load("luggage"), enough=3)


@pytest.fixture(scope="session")
def alike(few: Result) -> Result:
    """Eight designs in five families; the first two are the best in something."""
    bests = ["least error", "smallest within 1.5 times", *[""] * 6]
    heads = [few.candidates[number].id for number in (0, 1, 2, 3, 4, 0, 0, 1)]
    designs = zip(few.candidates[:8], heads, bests, strict=True)
    made = tuple(replace(each, family=name, best_at=best) for each, name, best in designs)
    return replace(few, candidates=made)


@pytest.fixture
def impossible(tmp_path: Path) -> Path:
    """A problem that no design satisfies."""
    text = problem_text("luggage").replace("transmission_min_deg = 15", "transmission_min_deg = 60")
    text = text.replace('"task"', '"cycle"').replace("[0.3, 8]", "[0.3, 5]")
    path = tmp_path / "impossible.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """One for all tests of a process: Playwright cannot be started twice in one."""
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
    path = next((name for name in found if name), None)
    if path is None:
        pytest.skip("no Chromium on this machine: the page is not tested in a browser")
    with pytest.importorskip("playwright.sync_api").sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        yield started
        started.close()

"""Shared by tests of the live page in a browser: what it shows, and waiting for it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grashof.problems import Problem
from grashof.problems.files.problem_schema import problem_from

if TYPE_CHECKING:
    from playwright.sync_api import Page

State = dict[str, Any]


def shown(page: Page, condition: str) -> State:
    """The page as soon as a condition holds for its state `s`."""
    there = "const s = window.grashof && window.grashof.state(); return s && s.listed"
    found: State = page.wait_for_function(
        f"() => {{ {there} && {condition} && s; }}", timeout=200_000
    ).json_value()
    return found


def searched(page: Page) -> State:
    """The page once its newest task is searched."""
    return shown(page, "s.listed.phase === 'found' && s.listed.version === s.version && !s.busy")


def problem_of(found: State) -> Problem:
    return problem_from(found["document"], "luggage")


def linkages(found: State) -> list[dict[str, Any]]:
    return [design["linkage"] for design in found["designs"]]


def keys(found: State) -> list[int]:
    return [design["key"] for design in found["designs"]]


def stated(designs: Any) -> list[dict[str, Any]]:
    return [{"mechanism": each.linkage.mechanism.word, **each.linkage.stated} for each in designs]


def place_of(page: Page, handle: str) -> tuple[float, float]:
    """Middle of a handle on the page, px."""
    found = f"document.querySelector(`[data-handle='{handle}'] .reach`).getBoundingClientRect()"
    x, y = page.evaluate(f"() => {{ const r = {found}; return [r.x + r.width / 2, r.y + r.height / 2]; }}")
    return x, y


def drag(page: Page, handle: str, by: tuple[float, float], steps: int = 5) -> None:
    """Drag a handle by px."""
    x, y = place_of(page, handle)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by[0], y + by[1], steps=steps)
    page.mouse.up()

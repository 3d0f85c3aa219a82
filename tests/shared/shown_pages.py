"""Shared by tests of pages in a browser: what a page says of itself, and waiting for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import product
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

Open = Callable[..., "Page"]


def state(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate("grashof.state()")
    return found


@contextmanager
def without_complaints(*pages: Page) -> Iterator[None]:
    """Nothing may appear on the console of these pages meanwhile."""
    complaints: list[str] = []
    listeners: dict[Any, Callable[[Any], None]] = {
        "console": lambda message: complaints.append(f"{message.type}: {message.text}"),
        "pageerror": lambda error: complaints.append(str(error)),
    }
    for page, event in product(pages, listeners):
        page.on(event, listeners[event])
    yield
    for page, event in product(pages, listeners):
        page.remove_listener(event, listeners[event])
    assert complaints == []


def box_of(shown: Locator) -> Any:
    """Its place and size on the page, px: x, y, width, height."""
    box = shown.bounding_box()
    assert box is not None
    return box


def wait_until(page: Page, condition: str) -> None:
    """As `page.wait_for_function`, which the page's own security policy forbids."""
    for _ in range(200):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(20)
    pytest.fail(f"never true: {condition}")

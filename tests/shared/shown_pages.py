"""Shared by tests of pages in a browser: what a page says of itself, and waiting for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

Open = Callable[..., "Page"]


def state(page: Page) -> dict[str, Any]:
    found: dict[str, Any] = page.evaluate("grashof.state()")
    return found


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

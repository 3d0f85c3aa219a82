"""A live page that is served, as a user starts it."""

from __future__ import annotations

import asyncio
import signal
import subprocess
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

import pytest
from command_runs import COMMAND
from live_pages import searched
from shown_pages import without_complaints

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page


@pytest.fixture(scope="package")
def server() -> Iterator[tuple[str, int]]:
    """A page that the command line serves: its address and the process; Ctrl-C has to end it."""
    command = [*COMMAND, "live", "luggage", "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    address = process.stdout.readline().strip()
    yield address, process.pid
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors) == (0, "")


@pytest.fixture(scope="package")
def served(server: tuple[str, int]) -> str:
    return server[0]


@pytest.fixture
def run() -> Callable[[Coroutine[Any, Any, Any]], Any]:
    """Runs a coroutine in a thread: that of the tests may have the loop of a browser."""

    def in_thread(coroutine: Coroutine[Any, Any, Any]) -> Any:
        with ThreadPoolExecutor(1) as thread:
            return thread.submit(asyncio.run, coroutine).result()

    return in_thread


@pytest.fixture(scope="module")
def window(browser: Browser) -> Iterator[Page]:
    opened = browser.new_page(viewport={"width": 1440, "height": 900})
    yield opened
    opened.close()


@pytest.fixture
def page(window: Page, served: str) -> Iterator[Page]:
    """A fresh live page whose first search is done; nothing may have been complained of."""
    with without_complaints(window):
        window.goto("about:blank")
        window.goto(served)
        searched(window)
        yield window

"""A live page that is served, as a user starts it."""

from __future__ import annotations

import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="package")
def served() -> Iterator[str]:
    """The address of a page that the command line serves; Ctrl-C has to end it."""
    command = [
        sys.executable,
        "-c",
        "from grashof.cli import main; main()",
        "live",
        "luggage",
        "--no-browser",
    ]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout is not None
    address = process.stdout.readline().strip()
    yield address
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=20)
    assert (process.returncode, errors) == (0, "")


@pytest.fixture(scope="package")
def chromium() -> str:
    found = [shutil.which(name) for name in ("chromium", "chromium-browser", "google-chrome")]
    path = next((name for name in found if name), None)
    if path is None:
        pytest.skip("no Chromium on this machine: the page is not tested in a browser")
    return path

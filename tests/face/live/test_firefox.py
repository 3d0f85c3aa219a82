"""The live page in Firefox, driven by WebDriver BiDi, which it speaks without a driver program."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

from grashof import load, synthesize

PATIENCE = 60  # s


class Firefox:
    """A window of Firefox."""

    def __init__(self, socket: ClientConnection) -> None:
        self.socket, self.number, self.errors = socket, 0, list[str]()
        self.ask("session.new", capabilities={})
        self.ask("session.subscribe", events=["log.entryAdded"])
        self.window = self.ask("browsingContext.getTree")["contexts"][0]["context"]

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command; its result."""
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": parameters}))
        while True:
            said = json.loads(self.socket.recv(timeout=PATIENCE))
            if said.get("method") == "log.entryAdded":
                self.errors += [str(said["params"]["text"])] * (said["params"]["level"] == "error")
            elif said.get("id") == self.number:
                assert said["type"] == "success", said
                found: dict[str, Any] = said["result"]
                return found

    def value(self, expression: str) -> Any:
        """The value of an expression, as JSON."""
        there = {"context": self.window}
        text = f"JSON.stringify(({expression}) ?? null)"
        found = self.ask("script.evaluate", expression=text, target=there, awaitPromise=False)
        assert found["type"] == "success", found
        return json.loads(found["result"]["value"])

    def until(self, expression: str) -> Any:
        """The value of an expression as soon as it is anything."""
        end = time.monotonic() + PATIENCE
        while not (found := self.value(expression)):
            assert time.monotonic() < end, expression
            time.sleep(0.05)
        return found


@pytest.fixture
def firefox(tmp_path: Path) -> Iterator[Firefox]:
    path = shutil.which("firefox") or shutil.which("firefox-esr")
    if path is None:
        pytest.skip("no Firefox on this machine: the page is not tested in it")
    command = [path, "--headless", "--no-remote", "--profile", str(tmp_path), "--remote-debugging-port", "0"]
    home = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin"}
    process = subprocess.Popen(
        command, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True, env=home
    )
    assert process.stderr is not None
    try:
        lines = (re.search(r"WebDriver BiDi listening on (ws://\S+)", line) for line in process.stderr)
        address = next(found[1] for found in lines if found)
        with connect(f"{address}/session", max_size=None) as socket:
            yield Firefox(socket)
    finally:
        process.kill()
        process.communicate()


@pytest.mark.slow
def test_firefox_shows_the_list_and_follows_a_pose(firefox: Firefox, served: str) -> None:
    firefox.ask("browsingContext.navigate", context=firefox.window, url=served, wait="complete")
    listed = (
        "window.grashof && (s => s.listed && s.listed.phase === 'found' && !s.busy && s)(grashof.state())"
    )
    first = firefox.until(listed)
    assert [one["id"] for one in first["designs"]] == [
        one.id for one in synthesize(load("luggage")).top(50).candidates
    ]
    place = "document.querySelector(`[data-handle='target-1'] .reach`).getBoundingClientRect()"
    x, y = firefox.value(f"(r => [r.x + r.width / 2, r.y + r.height / 2])({place})")
    hand = [
        {"type": "pointerMove", "x": round(x), "y": round(y)},
        {"type": "pointerDown", "button": 0},
        {"type": "pointerMove", "x": round(x) + 6, "y": round(y) - 8, "duration": 50},
        {"type": "pointerUp", "button": 0},
    ]
    mouse = {"type": "pointer", "id": "mouse", "actions": hand}
    firefox.ask("input.performActions", context=firefox.window, actions=[mouse])
    last = firefox.until(
        f"({listed}) && grashof.state().listed.version > {first['version']} && grashof.state()"
    )
    before, after = (each["document"]["motion"]["poses"] for each in (first, last))
    assert after[1][0] > before[1][0]
    assert after[1][1] > before[1][1]
    assert last["designs"]
    assert firefox.value("document.documentElement.scrollWidth <= innerWidth")
    assert firefox.errors == []

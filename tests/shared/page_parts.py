"""Shared by tests of pages: what is shown on them, and a page as a file, taken apart."""

from __future__ import annotations

import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np

from grashof.problems import FourBar, LinkageSpec, load_linkage_spec

RECORD: dict[str, Any] = {"versions": {"grashof": "0"}, "settings": {"seed": 0, "time_limit": None}}
HOSTILE = '</script><b onclick="x">=1+1 & "quoted"; -2</b>'
TITLE = "<script>document.title = 'caught'</script>"
ROCKER = FourBar((0, 0), (4, 0), 2, 2, 3, (1, 1))
# A long note, with a word that is too long for any line.
MISSES = "transmission_min_deg: the worst transmission angle over the turn in deg is 13.4955, allowed: "
MISSES += f"from 60; constraints: {'a_long_name_' * 20} is 3, allowed: up to 0"


LID = Path(__file__).parents[2] / "docs" / "lid.toml"


def placed_lid() -> LinkageSpec:
    """The lid of the documentation with its strut in a place of its own."""
    spec = load_linkage_spec(str(LID))
    assert spec.dynamics is not None
    assert spec.dynamics.effort is not None
    (part,) = spec.dynamics.effort.parts
    (foot, head), size = part.places, part.sizes[60]
    fixed = replace(part, between=(foot.placed(10, -50), head.placed(120, 20)), sizes=(size,))
    effort = replace(spec.dynamics.effort, parts=(fixed,))
    return replace(spec, dynamics=replace(spec.dynamics, effort=effort))


class Parts(HTMLParser):
    """Tags with their attributes, the text outside scripts and style, that of each group, and the data."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.groups: list[list[str]] = []
        self.text = ""
        self.data: Any = None
        self.inside, self.grouped = "", False
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attributes)))
        self.inside = "json" if ("id", "data") in attributes else tag
        if tag == "details" and ("class", "group") in attributes:
            self.groups.append([])
            self.grouped = True

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""
        self.grouped = self.grouped and tag != "details"

    def handle_data(self, data: str) -> None:
        if self.inside == "json":
            self.data = json.loads(data)
        elif self.inside not in ("script", "style"):
            self.text += data
            if self.grouped and data.strip():
                self.groups[-1].append(data.strip())

    @property
    def names(self) -> list[str]:
        return [tag for tag, _ in self.tags]

    def values(self, attribute: str) -> list[str]:
        """Every value of an attribute."""
        return [given[attribute] or "" for _, given in self.tags if attribute in given]

    def plot(self, key: str) -> dict[str, Any]:
        every = (plot for group in self.data["groups"] for plot in group)
        return next(plot for plot in every if plot["key"] == key)

    def column(self, number: int) -> np.ndarray:
        return np.array(self.data["columns"][number], dtype=float)

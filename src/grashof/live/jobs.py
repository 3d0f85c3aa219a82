"""Jobs for the solvers of the live page, and lines that come back; they go between processes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

KINDS = ("track", "search", "file", "outline")
FILES = ("problem", "list", "designs", "report", "dxf")


@dataclass(frozen=True, slots=True)
class Job:
    """Something to do for a page, one of `KINDS`, with the problem file as JSON and its name.

    Options are those of its kind: keys of designs, which file, the text of a drawing. `shown` is what the
    page has, as the job before left it.
    """

    what: str
    document: dict[str, Any]
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)
    shown: bytes = b""


@dataclass(frozen=True, slots=True)
class Line:
    """A line of JSON for the page, or the end of a job; `shown` is what the page has from now on."""

    text: str
    shown: bytes | None = None


def error_line(*lines: str) -> Line:
    """A line that tells what is wrong.

    >>> error_line("there is no design to save").text
    '{"kind": "error", "lines": ["there is no design to save"]}'
    """
    return Line(json.dumps({"kind": "error", "lines": list(lines)}))

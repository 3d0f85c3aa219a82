"""Jobs for the solvers of the live page, and lines that come back; they go between processes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

KINDS = ("task", "track", "search", "file")
FILES = ("problem", "list", "designs", "report", "dxf")


@dataclass(frozen=True, slots=True)
class Job:
    """Something to do for a page.

    Parameters
    ----------
    what : str
        track, search, file or task.
    document : dict
        The problem file as JSON.
    name : str
        What the problem is called.
    options : mapping
        Of a kind of job: for track and file, keys of designs.
    shown : bytes
        What the page has, as the job before left it.
    """

    what: str
    document: dict[str, Any]
    name: str
    options: Mapping[str, Any] = field(default_factory=dict)
    shown: bytes = b""


@dataclass(frozen=True, slots=True)
class Line:
    """A line for the page, or the end of a job.

    Parameters
    ----------
    text : str
        JSON, without a line break.
    shown : bytes, optional
        What the page has from now on.
    """

    text: str
    shown: bytes | None = None

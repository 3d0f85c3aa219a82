"""A self-contained page from a template, the style sheet, scripts and data."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import resources
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

# Scripts of every page with a moving drawing, in order.
DRAWING = (
    "kinds.js", "linkage.js", "svg.js", "scene.js", "labels.js", "stage.js", "grabbing.js", "player.js",
    "axes.js",
)  # fmt: skip

STRUTS = ("effort.js", "struts.js")  # after curves.js


def render(template: str, scripts: Sequence[str], data: Mapping[str, Any], **shown: Any) -> str:
    """A page that needs neither other files nor a network; its template escapes `shown`.

    The scripts, by name and in order, read the data as JSON without NaN.
    """
    return page_of(template, style=text_of("page.css"), script=script_of(scripts), data=data, **shown)


def script_of(scripts: Iterable[str]) -> str:
    """Scripts of this package joined in order."""
    return "\n".join(map(text_of, scripts))


def page_of(template: str, **shown: Any) -> str:
    """A page as HTML."""
    return _environment().get_template(template).render(**shown)


def compact(values: Iterable[float], digits: int = 5) -> list[float | None]:
    """Samples of a curve as short JSON: significant digits, null where a value is not finite."""
    return [float(f"{value:.{digits}g}") if math.isfinite(value) else None for value in values]


def plain(value: Any) -> Any:
    """A value as JSON has it; null where it is not finite."""
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and not math.isfinite(value) else value


@cache
def _environment() -> Environment:
    made = Environment(
        loader=PackageLoader("grashof.page"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    return made


@cache
def text_of(name: str) -> str:
    """A style sheet or script of this package."""
    return (resources.files("grashof.page") / "templates" / name).read_text(encoding="utf-8")

"""The front end of the live page: the modules of the reports, and its own."""

from __future__ import annotations

import json
from collections.abc import Callable

from grashof.page.render import DRAWING, STRUTS, page_of, script_of, text_of

SCRIPTS = (
    *DRAWING,
    *("picture.js", "curves.js", "table.js", "compare.js", "saving.js", *STRUTS),
    *("live/task.js", "live/places.js"),
    "live/handles.js",
    *("live/backdrop.js", "live/form.js", "live/listing.js", "live/transport.js", "live/commands.js"),
    *("live/sharing.js", "live/live.js"),
)


def live_script() -> str:
    """All scripts in one, which defines `startLive`."""
    return f'"use strict";\n(() => {{\n{script_of(SCRIPTS)}\nwindow.startLive = startLive;\n}})();\n'


def live_style() -> str:
    """Both style sheets."""
    return text_of("page.css") + text_of("live/live.css")


def widget_module() -> str:
    """The module of the notebook's widget, which contains the page."""
    page = page_of("live/live.html", style=live_style(), script=live_script())
    return f"const PAGE = {json.dumps(page)};\n{text_of('live/widget.js')}"


# Content and type of each address.
FRONT: dict[str, Callable[[], tuple[str, str]]] = {
    "/": lambda: (page_of("live/live.html", script=""), "text/html"),
    "/live.css": lambda: (live_style(), "text/css"),
    "/live.js": lambda: (live_script(), "text/javascript"),
    "/start.js": lambda: (text_of("live/start.js"), "text/javascript"),
}

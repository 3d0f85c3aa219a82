"""Results on disk: files that are there whole or not at all, and the versions that they depend on."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

PACKAGES = ("grashof", "casadi", "numpy", "scipy")  # whose versions may change a digit
WRITING = ".writing-"  # how names of files begin that are not whole yet


@cache
def versions() -> dict[str, str]:
    """Of the packages that decide which designs are found."""
    return {name: version(name) for name in PACKAGES}


def write_whole(path: Path, content: Mapping[str, Any] | str) -> None:
    """A file, JSON or text, that is there whole or not at all, whenever the machine stops.

    `OSError` where the disk is full or the folder is lost; nothing is left of the file then.
    """
    beside = path.with_name(f"{WRITING}{os.getpid()}-{path.name}")
    try:
        with beside.open("w", encoding="utf-8", newline="\n") as file:
            file.write(content if isinstance(content, str) else json.dumps(content))
            file.flush()
            os.fsync(file.fileno())
        beside.replace(path)
    except OSError as error:
        with suppress(OSError):
            beside.unlink()
        if error.strerror is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from None  # a full disk names no file

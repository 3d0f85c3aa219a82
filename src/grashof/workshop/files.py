"""Files written whole or not at all."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from grashof.problems import LinkageSpec
from grashof.problems.values.specs.linkage_spec import ListedDesign
from grashof.workshop.formats import dxf, svg
from grashof.workshop.plan import Plan
from grashof.workshop.sheet import sheet
from grashof.workshop.workbook import workbook

if TYPE_CHECKING:
    import pandas as pd


def write_dxf(path: str | os.PathLike[str], plan: Plan, title: str = "") -> None:
    """Write the parts, the assembly and the parts list as DXF, in mm.

    Parameters
    ----------
    path : str or path-like
    plan : Plan
    title : str
        Stands over the parts list.

    Raises
    ------
    ProblemError
        ezdxf is not installed.
    OSError
        The file cannot be written; what was there before stays.
    """
    write_whole({Path(path): dxf(sheet(plan, title)).encode("utf-8")})


def write_svg(path: str | os.PathLike[str], plan: Plan, title: str = "") -> None:
    """Write the same drawing as SVG, in mm; parameters as for `write_dxf`."""
    write_whole({Path(path): svg(sheet(plan, title)).encode("utf-8")})


def write_xlsx(
    path: str | os.PathLike[str],
    chosen: Sequence[LinkageSpec | ListedDesign],
    candidates: pd.DataFrame | None = None,
) -> None:
    """Write an Excel workbook; parameters as for `workbook`.

    Raises
    ------
    ProblemError
        openpyxl is not installed.
    OSError
        The file cannot be written; what was there before stays.
    """
    write_whole({Path(path): workbook(chosen, candidates)})


def write_whole(contents: Mapping[Path, bytes]) -> None:
    """Write files beside their places first, and put them there when all are whole.

    OSError names the file whose disk is full or folder is lost; every file is then as it was before.
    """
    with ExitStack() as folders:
        fresh = {}
        for path, content in contents.items():
            try:
                beside = tempfile.TemporaryDirectory(dir=path.parent, prefix=".writing-")
                fresh[path] = Path(folders.enter_context(beside)) / path.name
                fresh[path].write_bytes(content)
            except OSError as error:
                raise OSError(error.errno, error.strerror, str(path)) from None
        for path, file in fresh.items():
            file.replace(path)

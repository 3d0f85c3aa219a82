"""NumPy functions on CasADi symbols."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import casadi as ca

from grashof.analysis.judge.design import Constraint, Design

_WARNS, _SILENT = 0, -1  # modes of CasADi for NumPy functions that meet symbols; both do what 3.7.2 did


@contextmanager
def numpy_on_symbols() -> Iterator[None]:
    """NumPy functions give symbols of symbols, and do not warn."""
    # CasADi from 3.8 on warns whoever calls a NumPy function on symbols that a later version may give arrays.
    # The mode is of the whole process: it is put back, and left alone where it is not the default.
    options = ca.GlobalOptions
    if not hasattr(options, "setNumpyMode") or options.getNumpyMode() != _WARNS:
        yield
        return
    options.setNumpyMode(_SILENT)
    try:
        yield
    finally:
        options.setNumpyMode(_WARNS)


def on_symbols(constraint: Constraint, design: Design) -> Any:
    """What a constraint gives on the symbols of a design."""
    with numpy_on_symbols():
        return constraint(design)

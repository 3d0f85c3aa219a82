"""A user's own constraint evaluated on symbols."""

from __future__ import annotations

from typing import Any

import casadi as ca

from grashof.analysis.judge.design import Constraint, Design

_WARNS, _SILENT = 0, -1  # modes of CasADi for NumPy functions that meet symbols; both do what 3.7.2 did


def on_symbols(constraint: Constraint, design: Design) -> Any:
    """What a constraint gives on the symbols of a design; NumPy functions in it do not warn.

    CasADi from 3.8 on warns whoever calls a NumPy function on symbols that a later version may give
    arrays. What comes back is turned into symbols here at once, so that nothing hangs on it. The mode
    is of the whole process: it is put back, and left alone where it is not the default.
    """
    options = ca.GlobalOptions
    if not hasattr(options, "setNumpyMode") or options.getNumpyMode() != _WARNS:
        return constraint(design)
    options.setNumpyMode(_SILENT)
    try:
        return constraint(design)
    finally:
        options.setNumpyMode(_WARNS)

"""Grashof finds planar linkages that do a job, proves that they do it, and ranks them."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from grashof.problems import GrashofError, load
    from grashof.synth import synthesize

__all__ = ["GrashofError", "load", "synthesize"]

# Loaded on first use: `import grashof.analysis` must not pay for, or depend on, CasADi.
_HOMES = {"GrashofError": "problems", "load": "problems", "synthesize": "synth"}


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        return getattr(import_module(f"grashof.{_HOMES[name]}"), name)
    raise AttributeError(f"module 'grashof' has no attribute {name!r}")

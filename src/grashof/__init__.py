"""Grashof finds planar linkages that do a job, proves that they do it, and ranks them."""

TYPE_CHECKING = False  # as in `typing`, which takes as long to load as Python itself
if TYPE_CHECKING:
    from grashof.figures import (
        animate,
        plot_coupler_curve,
        plot_design_space,
        plot_dynamics,
        plot_kinematics,
        plot_linkage,
    )
    from grashof.problems import GrashofError, load
    from grashof.synth import synthesize, track

__all__ = [
    "GrashofError",
    "animate",
    "load",
    "plot_coupler_curve",
    "plot_design_space",
    "plot_dynamics",
    "plot_kinematics",
    "plot_linkage",
    "synthesize",
    "track",
]

# Loaded on first use: `import grashof.analysis` must not pay for, or depend on, CasADi.
_HOMES = {
    "GrashofError": "problems",
    "load": "problems",
    "synthesize": "synth",
    "track": "synth",
    **dict.fromkeys((name for name in __all__ if name.startswith(("animate", "plot_"))), "figures"),
}


def __getattr__(name: str) -> object:
    from importlib import import_module

    if name in _HOMES:
        found: object = getattr(import_module(f"grashof.{_HOMES[name]}"), name)
        return found
    raise AttributeError(f"module 'grashof' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

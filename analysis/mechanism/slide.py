"""How far a slide has gone, from the position alone."""

from __future__ import annotations

import numpy as np

from grashof.analysis.mechanism.position import Position
from grashof.problems import InvertedSliderCrank, Linkage, SliderCrank
from grashof.problems.values.arrays import FloatArray


def slide_travel(linkage: Linkage, state: Position) -> FloatArray:
    """Travel of the slide of a linkage, shape (...), length; NaN of a linkage without one.

    Along the slide from where O2 is nearest to it, or along the rod from A to B, as `SlideMotion` has it
    with its rates; also in dead positions, where those have none.

    Examples
    --------
    >>> from grashof.analysis import solve_position
    >>> engine = SliderCrank(o2=(0, 0), r2=40, r3=120)
    >>> slide_travel(engine, solve_position(engine, np.radians([0, 180]))).tolist()
    [160.0, 80.0]
    """
    if isinstance(linkage, SliderCrank):
        along, way = linkage.slide_angle, state.b - linkage.o2
    elif isinstance(linkage, InvertedSliderCrank):
        along, way = state.theta3, state.b - state.a
    else:
        return np.full(np.shape(state.theta2), np.nan)
    travel: FloatArray = way[..., 0] * np.cos(along) + way[..., 1] * np.sin(along)
    return travel

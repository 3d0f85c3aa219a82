"""Linkages as a search has them."""

from dataclasses import replace

import numpy as np

from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank


def as_found(linkage: Linkage) -> Linkage:
    """The same linkage as a search has it: a slide, or a rod, taken the way on which B lies ahead of A."""
    if linkage.assembly > 0 or isinstance(linkage, FourBar):
        return linkage
    if isinstance(linkage, SliderCrank):
        return replace(linkage, slide_angle=linkage.slide_angle + np.pi, offset=-linkage.offset, assembly=1)
    assert isinstance(linkage, InvertedSliderCrank)
    turned = {"coupler_point": -linkage.coupler_point, "body_angle": linkage.body_angle + np.pi}
    return replace(linkage, offset=-linkage.offset, assembly=1, **turned)

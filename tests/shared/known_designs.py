"""Designs: as a search has them, how far apart they are, and the best of some strokes."""

from dataclasses import replace

import numpy as np

from grashof.problems import FourBar, InvertedSliderCrank, Linkage, SliderCrank, Task

# The best slider-cranks by their time ratio, with unit stroke.
SLIDES = [  # time ratio, best worst mu in deg, r2, r3, offset
    (1.05, 67.641, 0.49088, 2.53044, 0.47171),
    (1.1, 58.852, 0.48302, 1.79519, 0.44555),
    (1.2, 47.201, 0.47047, 1.27911, 0.39859),
    (1.25, 42.808, 0.46554, 1.14896, 0.37738),
    (1.5, 27.458, 0.45074, 0.83284, 0.28828),
    (2.0, 11.211, 0.45078, 0.62481, 0.16211),
    (2.5, 3.214, 0.47051, 0.54314, 0.07177),
]


def as_found(linkage: Linkage) -> Linkage:
    """The same linkage as a search has it: a slide, or a rod, taken the way on which B lies ahead of A."""
    if linkage.assembly > 0 or isinstance(linkage, FourBar):
        return linkage
    if isinstance(linkage, SliderCrank):
        return replace(linkage, slide_angle=linkage.slide_angle + np.pi, offset=-linkage.offset, assembly=1)
    assert isinstance(linkage, InvertedSliderCrank)
    turned = {"coupler_point": -linkage.coupler_point, "body_angle": linkage.body_angle + np.pi}
    return replace(linkage, offset=-linkage.offset, assembly=1, **turned)


def share_apart(task: Task, one: FourBar, other: FourBar) -> float:
    """Largest difference of places from the middle of the task, lengths and coupler point, as a share."""
    middle = task.positions.mean(axis=0)
    x, y = (
        np.array([*(a.o2 - middle), *(a.o4 - middle), a.r2, a.r3, a.r4, *a.coupler_point])
        for a in (one, other)
    )
    return float(np.abs(x - y).max() / np.abs([x, y]).max())

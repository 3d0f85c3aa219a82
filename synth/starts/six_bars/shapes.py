"""Shapes of linkages of any mechanism, whose loops close by construction, with derivatives.

With O2 = 0 and r1 = 1 (of a slide in the first loop r3 = 1) a shape is a row of free numbers: shares of the
possible lengths of each loop (see `feasible`), the places of C and D, the direction of a slide. The gap
between C and D is sampled over the motion of the first loop, so that the last lengths are those that close it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from grashof.problems.values.arrays import TURN, BoolArray, FloatArray, IntArray
from grashof.problems.values.linkages.mechanism import LoopNames, Mechanism, Parameter
from grashof.synth.loop.chain import DYADS, Chain, chained
from grashof.synth.loop.dual import Dual
from grashof.synth.loop.feasible import Demand, bars_between, feasible
from grashof.synth.loop.vector import Vector

SAMPLES = 48  # of the motion, for the extremes of a gap
SHORT = 2e-3  # share by which samples may understate these
STEP = 1e-6  # of derivatives by differences
LONGER = 0.4  # share of drivers longer than the ground link
SPREAD = 1.0  # of random places of C and D, over r1
SIDES = 2  # ends of a driver's range among the columns of derivatives


class Motion(NamedTuple):
    """Driver angles over which loops close, and transmit: a full turn, or from `low` to `high`, (n,)."""

    low: FloatArray
    high: FloatArray


@dataclass(frozen=True, slots=True)
class Closing:
    """The motion over which the loops of a shape close, and the least transmission angle."""

    turning: bool = True  # all round; otherwise over the task motion alone
    transmission: float = 0.0  # rad
    over_turn: bool = True  # that angle all round; otherwise over the task motion
    margin: float = 0.0  # of full rotation

"""Words among the requirements."""

from __future__ import annotations

from enum import StrEnum


class Rotatability(StrEnum):
    """The rotation that the driver must be capable of."""

    FULL_CRANK = "full-crank"
    CRANK_ROCKER = "crank-rocker"
    DOUBLE_CRANK = "double-crank"
    ANY = "any"


class TransmissionOver(StrEnum):
    """The motion over which the transmission angle is judged."""

    TASK = "task"
    CYCLE = "cycle"

"""A driver in two plates: the return crank is fixed on the one crank pin, and carries the other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from grashof.problems.values.arrays import FloatArray
from grashof.workshop.plates import Plate, PlateSizes, bar, plate_of

DRIVER, RETURN_CRANK = "driver", "return crank"


class ReturnCrank(NamedTuple):
    """A driver in two plates on `pin`, of which the return crank, `turned` by so many rad, holds `far`."""

    pin: str
    far: str
    turned: float
    plates: dict[str, Plate]

    def pinned(self, joints: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
        """What each pin joins then."""
        found = dict(joints)
        found[self.pin] = (*joints[self.pin], RETURN_CRANK)
        found[self.far] = tuple(RETURN_CRANK if part == DRIVER else part for part in joints[self.far])
        return found

    def placed(self, places: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
        """The places of links and pins, with that of the return crank."""
        angle = places[DRIVER][:, 2] + self.turned
        return {**places, RETURN_CRANK: np.column_stack([places[self.pin][:, :2], angle])}


def return_cranks(plates: Mapping[str, Plate], sizes: PlateSizes) -> Iterator[ReturnCrank]:
    """The two ways to divide a driver that has two crank pins, A and C; none of others."""
    driver = plates[DRIVER]
    for pin, far in (("A", "C"), ("C", "A")):
        holes = dict(zip(driver.joints, driver.holes, strict=True))
        if far not in holes or pin not in holes:
            continue
        x, y = holes.pop(far) - holes[pin]
        crank = bar(RETURN_CRANK, (pin, far), (0.0, float(np.hypot(x, y))), sizes)
        divided = {DRIVER: plate_of(DRIVER, holes, sizes), RETURN_CRANK: crank}
        yield ReturnCrank(pin, far, float(np.arctan2(y, x)), {**plates, **divided})

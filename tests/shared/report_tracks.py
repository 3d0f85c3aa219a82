"""Paths that the luggage report fits: centres of its links, from its table 7."""

import numpy as np
import numpy.typing as npt

from grashof.analysis import solve_position
from grashof.problems import FourBar

Floats = npt.NDArray[np.float64]
LENGTHS = (3.91882993, 3.2349043, 4.09244415, 3.70202612)
POSE_1 = 74.03230655  # deg, of the driver
# Its 101 samples run from pose 1 over pose 4 and a turn; it fits every third from the first, eleven in all.
STEP = (360 + 121.9353869) / 100  # deg
ELEVEN = np.arange(0.0, 31, 3)


def theta2_of(sample: npt.ArrayLike) -> Floats:
    return np.radians(POSE_1 + STEP * np.asarray(sample))


def centre(link: int, theta2: npt.ArrayLike) -> Floats:
    """Halfway along link 2, 3 or 4, shape (..., 2); the ground at 51.45 deg, O2 in the origin."""
    r1, r2, r3, r4 = LENGTHS
    ground = np.radians(51.45)
    linkage = FourBar((0, 0), (r1 * np.cos(ground), r1 * np.sin(ground)), r2, r3, r4)
    state = solve_position(linkage, theta2)
    return {2: state.a, 3: state.a + state.b, 4: linkage.o4 + state.b}[link] / 2

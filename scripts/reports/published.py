"""Values that the two reports print and Grashof takes from them: none of them is a result."""

import numpy as np

from grashof.analysis import given_masses
from grashof.problems import FourBar

# The luggage linkage as its report prints it: lengths, ground direction, driver angles of poses 1 and 4. The
# direction is printed as 51.45 deg; the audit's torques at its samples agree to the last digit with 51.4499.
R1, R2, R3, R4 = 3.91882993, 3.23490430, 4.09244415, 3.70202612
GROUND, POSE_1, JOB = np.radians([51.4499, 74.03230655, 121.9353869])
LUGGAGE = FourBar((0, 0), (R1 * np.cos(GROUND), R1 * np.sin(GROUND)), R2, R3, R4)
# Slender bars: the printed inertias, 0.3282, 0.6646 and 0.4920, are these rounded.
BARS = ((0.3764, R2), (0.4762, R3), (0.4308, R4))
MASSES = given_masses(LUGGAGE, [m for m, _ in BARS], [m * length**2 / 12 for m, length in BARS])
# Its 101 samples run over the job and a full turn; curves are fitted through eleven of the first thirty-one.
SAMPLES, STEP = 101, (2 * np.pi + JOB) / 100
ELEVEN = np.arange(0.0, 31.0, 3.0)
H = np.radians(5)  # its divisor of differences
GRAVITY = 9.81  # m/s2, which it leaves out

# Table 7: driver and coupler angles in deg.
BETA = (33.47858461, 65.83725805, 121.93538690)
GAMMA = (384.41769000, 412.60236923, 99.63996916)

# The pumpjack: 15 s at 20 rpm in steps of 0.05 s from 90 deg; bars of 0.2 x 0.2 m.
SECONDS, TIME_STEP, START_DEG = 15.0, 0.05, 90.0
DENSITIES, SIDE = (7800.0, 7800.0, 7850.0), 0.2
PICTURES = (0.0, 90.0, 180.0, 135.0)  # deg: a model
CENTRES = {"crank": (0.0, 2.0969), "coupler": (1.88595, 2.6938), "beam": (3.88595, 3.5969)}
SYSTEM = (2.92, 3.19)
BEAM = 7.62  # m
# Lufkin C-912D-427-144 in inches, as its maker names them.
CATALOGUE = {"R": 47.0, "P": 148.5, "C": 120.03, "A": 180.0, "I": 120.0, "H": 262.0, "G": 111.0}
STROKE, TORQUE_FACTOR = "144", "68.82"
TORQUE = ("66.48", "-28.90", "9.48")  # N m: greatest, least, effective
MASS = "3941.98"  # kg
RESIDUALS = (5.96e-6, 4.60e-6)  # m

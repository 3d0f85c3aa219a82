"""Make synth/data/four-bar.npz anew: all solutions of the nine-point problem for general points.

Takes some minutes. From another seed come other points, and as many solutions.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from grashof.synth.theory.point_families import FOUR_BARS
from grashof.synth.theory.solutions import collect, general_problem


def main(argv: Sequence[str] | None = None) -> int:
    """Find the solutions and write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(argv)
    rng = np.random.default_rng(options.seed)
    displacements, first = general_problem(FOUR_BARS, rng)
    solutions = collect(
        FOUR_BARS, displacements, first, rng, FOUR_BARS.count, progress=lambda known: print(known, flush=True)
    )
    refined = FOUR_BARS.refined(solutions, displacements).astype(np.complex64)
    np.savez_compressed(options.file, displacements=displacements, solutions=refined)
    return 0


if __name__ == "__main__":
    sys.exit(main())

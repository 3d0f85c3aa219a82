"""Make the data of sliders through eight points anew, a file a kind in synth/data: all for general points.

Takes some minutes. From another seed come other points, and as many solutions.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from grashof.synth.theory.point_families import INVERTED_SLIDER_CRANKS, SLIDER_CRANKS
from grashof.synth.theory.solutions import collect, general_problem

FAMILIES = {family.name: family for family in (SLIDER_CRANKS, INVERTED_SLIDER_CRANKS)}


def main(argv: Sequence[str] | None = None) -> int:
    """Find the solutions of each kind until loops bring no more, and write them in single precision."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=FAMILIES, help="this kind alone")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--patience", type=int, default=6, help="consecutive loops without a new one that end it"
    )
    options = parser.parse_args(argv)
    for name, family in FAMILIES.items():
        if options.only not in (None, name):
            continue
        rng = np.random.default_rng(options.seed)
        displacements, first = general_problem(family, rng)
        solutions = collect(
            family, displacements, first, rng,
            patience=options.patience, progress=lambda known: print(known, flush=True),
        )  # fmt: skip
        np.savez_compressed(
            options.folder / f"{name}.npz",
            displacements=displacements,
            solutions=family.refined(solutions, displacements).astype(np.complex64),
        )
        print(f"{name}: {len(solutions)} solutions, cognates as one")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Regenerate the files of `point_families` in synth/data: all solutions of each kind for general points.

Each takes some minutes. Another seed gives other points and the same number of solutions.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from grashof.synth.theory.point_families import FAMILIES
from grashof.synth.theory.solutions import collect, general_problem


def main(argv: Sequence[str] | None = None) -> int:
    """Find the solutions of each kind until loops bring no more, and write them in single precision."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=FAMILIES, help="this kind alone")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--patience", type=int, default=8, help="it stops after this many loops without a new one"
    )
    options = parser.parse_args(argv)
    for name in FAMILIES if options.only is None else (options.only,):
        family, rng = FAMILIES[name], np.random.default_rng(options.seed)
        displacements, first = general_problem(family, rng)
        solutions = collect(
            family, displacements, first, rng,
            patience=options.patience, progress=lambda known: print(known, flush=True),
        )  # fmt: skip
        solutions = family.refined(solutions, displacements).astype(np.complex64)
        np.savez_compressed(options.folder / f"{name}.npz", displacements=displacements, solutions=solutions)
        print(f"{name}: {len(solutions)} solutions, cognates as one")
    return 0


if __name__ == "__main__":
    sys.exit(main())

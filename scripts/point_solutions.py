"""Make the files of `nine_points` and `eight_points` in synth/data anew: all solutions for general points.

Takes some minutes for each. From another seed come other points, and as many solutions.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from grashof.synth.theory import eight_points, monodromy
from grashof.synth.theory.eight_points import FAMILIES

NINE = "nine_points"


def main(argv: Sequence[str] | None = None) -> int:
    """Find the solutions of each kind until loops bring no more, and write them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", choices=(NINE, *FAMILIES), help="this kind alone")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--patience", type=int, default=8, help="it stops after this many loops without a new one"
    )
    options = parser.parse_args(argv)
    for name in (NINE, *FAMILIES) if options.only is None else (options.only,):
        rng = np.random.default_rng(options.seed)
        more: dict[str, Any] = {}
        if name == NINE:
            displacements, first = monodromy.general_problem(rng)
        else:
            family = FAMILIES[name]
            displacements, first = eight_points.general_problem(family, rng)
            more = {"most": 10**6, "system": family.system, "distinct": family.distinct}
        solutions = monodromy.collect(
            displacements, first, rng, patience=options.patience,
            progress=lambda known: print(known, flush=True), **more,
        )  # fmt: skip
        if name != NINE:
            solutions = family.refined(solutions, displacements).astype(np.complex64)
        np.savez_compressed(options.folder / f"{name}.npz", displacements=displacements, solutions=solutions)
        print(f"{name}: {len(solutions)} solutions, cognates as one")
    return 0


if __name__ == "__main__":
    sys.exit(main())

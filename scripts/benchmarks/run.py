"""Run a benchmark: ``python scripts/benchmarks/run.py planted --only timed --count 20``.

A benchmark is a module beside this one; its ``CASES`` print lines of their own. Times are wall-clock after
imports where nothing else is stated: run it on a quiet machine, with OPENBLAS_NUM_THREADS=1. Exit code 1: a
line that ends with "!" reports a failure.
"""

import argparse
import os
import sys
from collections.abc import Sequence
from importlib import import_module

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before NumPy is loaded

BENCHMARKS = (
    "catalogue", "costs", "eight_points", "kinematics", "limited", "outputs", "pages", "planted", "proofs",
    "rounds", "six_bars", "struts", "wanted_torque",
)  # fmt: skip


def main(argv: Sequence[str] | None = None) -> int:
    """Print the lines of the chosen cases."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("benchmark", choices=BENCHMARKS)
    parser.add_argument("--only", default="", help="part of the name of a case")
    parser.add_argument("--count", type=int, help="tasks, repetitions or size of each case")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(argv)
    failed = False
    for case in import_module(options.benchmark).CASES:
        if options.only in case.name:
            for line in case.measure(case.usual if options.count is None else options.count, options.seed):
                print(f"{case.name}: {line}", flush=True)
                failed |= line.endswith("!")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())

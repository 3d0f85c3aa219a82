"""Measure how long the page of a search takes to make, and how large it is.

Prints one line a step: the median over repetitions, on this machine. Run it on a quiet one.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from grashof import load, synthesize
from grashof.page.search import search_page
from grashof.synth.designs.table import rows_of

RECORD = {"versions": {"grashof": ""}, "settings": {}}


def main(argv: Sequence[str] | None = None) -> int:
    """Print times and size."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problem", nargs="?", default="luggage", help="Catalogue name or TOML file.")
    parser.add_argument("--designs", type=int, default=200, help="In the page; the list repeats to fill it.")
    parser.add_argument("--runs", type=int, default=5, help="Repetitions.")
    chosen = parser.parse_args(argv)
    found = synthesize(load(chosen.problem))
    repeated = found.candidates * -(-chosen.designs // max(len(found), 1))
    result = replace(found, candidates=repeated[: chosen.designs])
    times: list[tuple[float, float]] = []
    with TemporaryDirectory() as folder:
        path = Path(folder) / "report.html"
        for _ in range(chosen.runs):
            begun = perf_counter()
            rows = rows_of(result.problem, result.candidates)
            figured = perf_counter()
            path.write_text(search_page(result, RECORD, rows=rows), encoding="utf-8")
            times.append((figured - begun, perf_counter() - figured))
        size = path.stat().st_size
    figures, page = (median(each) for each in zip(*times, strict=True))
    print(f"{chosen.problem}, {len(result)} designs ({len(found)} distinct)")
    print(f"values of the list: {figures:.2f} s")
    print(f"page made and written: {page:.2f} s, {size / 1e6:.2f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())

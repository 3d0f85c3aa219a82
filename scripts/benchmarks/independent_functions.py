"""Find the function generators of least greatest error by a second way, and hold Grashof's against them.

Four-bars with a least transmission angle over the range: the loop is closed by the elbow formula, and SLSQP
of scipy lowers the greatest error at many places of the range from random starts, with differences for
derivatives. It shares no formula with `grashof.synth`, and judges nothing but by its own loop.
"""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from time import perf_counter
from typing import Any

import numpy as np
from scipy.optimize import minimize

from grashof.problems import FunctionTask, Problem, Requirements
from grashof.problems.values.arrays import FloatArray
from grashof.synth import synthesize

COARSE, MIDDLE, FINE = 25, 121, 721  # places of the range: from random starts, for the best, at the end
RATIO, FAR = 10.0, 5.0
TOWARD = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0])  # less error
# Law, its range and exponent, rotation of driver and output, least transmission angle; deg.
ASKED = (
    ("log10", (1.0, 2.0), None, 60.0, 90.0, 30.0),
    ("log10", (1.0, 2.0), None, 60.0, 90.0, 40.0),
    ("sqrt", (1.0, 4.0), None, 90.0, 90.0, 30.0),
    ("power", (1.0, 4.0), 1.5, 90.0, 90.0, 40.0),
    ("power", (1.0, 3.0), 0.8, 90.0, 90.0, 40.0),
)


@dataclass(frozen=True, slots=True)
class Generator:
    """What the search varies: logarithms of r2, r3 and r4 (r1 = 1), first driver angle, zero, error."""

    task: FunctionTask
    least: float
    output_sense: int
    assembly: int

    def loop(self, unknowns: FloatArray, turned: FloatArray) -> tuple[FloatArray, FloatArray]:  # closure: RRR
        """Output angle, and the cosine of the transmission angle; beyond 1 where the loop is open."""
        r2, r3, r4 = np.exp(np.clip(unknowns[:3], -FAR, FAR))
        seen = r2 * np.exp(1j * (unknowns[3] + turned)) - 1
        square = np.abs(seen) ** 2
        at_o4 = np.clip((square + r4**2 - r3**2) / (2 * np.sqrt(square) * r4), -1, 1)
        psi = np.unwrap(np.angle(seen)) - self.assembly * np.arccos(at_o4)
        return psi - psi[0], (r3**2 + r4**2 - square) / (2 * r3 * r4)

    def errors(self, unknowns: FloatArray, places: int) -> FloatArray:
        """Structural error over the range, rad."""
        turned = np.linspace(*self.task.span, places)
        wanted = self.output_sense * self.task.output(turned)
        found: FloatArray = self.loop(unknowns, turned)[0] - wanted - unknowns[4]
        return found

    def kept(self, unknowns: FloatArray) -> FloatArray:
        """Zero or positive where limits are kept: link ratios, and the transmission where it is extreme."""
        span = self.task.span
        passed = (np.array([0.0, np.pi]) - unknowns[3]) % (2 * np.pi)
        at = np.concatenate([span, np.where(passed <= span[1], passed, span[0])])
        _, cosine = self.loop(unknowns, at)
        logs = np.append(unknowns[:3], 0.0)
        ratios = np.log(RATIO) - (logs[:, None] - logs[None, :])[~np.eye(4, dtype=bool)]
        most = np.cos(self.least)
        return np.concatenate([most - cosine, most + cosine, ratios])

    def improved(self, unknowns: FloatArray, places: int, steps: int) -> FloatArray:
        """The greatest error lowered."""

        def rows(x: FloatArray) -> FloatArray:
            error = self.errors(x, places)
            return np.concatenate([x[5] - error, x[5] + error, self.kept(x)])

        def error(x: FloatArray) -> float:
            return float(x[5])

        def change(_: FloatArray) -> FloatArray:
            return TOWARD

        def rows_change(x: FloatArray) -> FloatArray:
            return slopes(rows, x)

        limits: Any = {"type": "ineq", "fun": rows, "jac": rows_change}
        least: Any = {"maxiter": steps, "ftol": 1e-15}
        made = minimize(
            error, unknowns, method="SLSQP", jac=change, options=least,
            bounds=[(-FAR, FAR)] * 3 + [(-10, 10)] * 2 + [(0, 10)],
            constraints=limits,
        )  # fmt: skip
        found: FloatArray = made.x
        return found

    def greatest(self, unknowns: FloatArray) -> float:
        """Greatest error over a fine range, rad; infinite where a limit is missed."""
        if not np.isfinite(unknowns).all() or self.kept(unknowns).min() < -1e-7:
            return np.inf
        return float(np.ptp(self.errors(unknowns, 4001))) / 2


def slopes(rows: Callable[[FloatArray], FloatArray], x: FloatArray) -> FloatArray:
    """Derivatives by central differences."""
    step = 1e-6
    found = [(rows(x + move) - rows(x - move)) / (2 * step) for move in step * np.eye(len(x))]
    return np.stack(found, axis=1)


def independent(task: FunctionTask, least: float, starts: int, rng: np.random.Generator) -> float:
    """The least greatest error that is found, rad."""
    tried = []
    for sense, assembly in product((1, -1), repeat=2):
        generator = Generator(task, least, sense, assembly)
        for _ in range(starts):
            x = np.concatenate([rng.normal(0, 0.7, 3), rng.uniform(-np.pi, np.pi, 1), [0.0, 0.5]])
            x = generator.improved(x, COARSE, 60)
            tried.append((generator.greatest(x), generator, x))
    best = sorted((one for one in tried if np.isfinite(one[0])), key=lambda one: one[0])[:12]
    for places, most in ((MIDDLE, 3), (FINE, 1)):
        finer = [(generator, generator.improved(x, places, 300)) for _, generator, x in best]
        best = sorted(((one.greatest(x), one, x) for one, x in finer), key=lambda one: one[0])[:most]
    return best[0][0]


def main(argv: Sequence[str] | None = None) -> int:
    """Compare and print; 1 where the other search has less error by more than 1e-6."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("--starts", type=int, default=60, help="of the independent search, for each sense")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(argv)
    worse = 0
    for law, x, exponent, turned, output, least in ASKED:
        task = FunctionTask.from_degrees(
            law=law, x=x, exponent=exponent, input_range_deg=turned, output_range_deg=output,
            sense="either", norm="max",
        )  # fmt: skip
        since = perf_counter()
        wanted = Requirements(link_ratio_max=RATIO, transmission_min_deg=least)
        best = synthesize(Problem(task=task, requirements=wanted)).best
        seconds = perf_counter() - since
        own = best.verdict.structural_error_max
        other = independent(task, np.radians(least), options.starts, np.random.default_rng(options.seed))
        worse += own > other * (1 + 1e-6)
        own, other = np.degrees([own, other])
        print(
            f"{law} {x} {exponent or ''} at least {least:g} deg: Grashof {own:.9f} deg in {seconds:.1f} s, "
            f"independent {other:.9f} deg",
            flush=True,
        )
    return int(worse > 0)


if __name__ == "__main__":
    raise SystemExit(main())

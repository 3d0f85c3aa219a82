"""Measure Grashof and its alternatives on the same tasks, judged by one judge.

    pip install '.[bench]' && python scripts/benchmarks/compare.py --out benchmark

Packages run one after another in one process, single-threaded. Each run yields the processor time to the
first design that the judge accepts within 1 % of the least error of any run (for exact tasks: to rounding),
the number of distinct ones, and the accepted share of the designs returned. Writes `runs.json`, `table.md`
and `profile.png`, the performance profiles of Dolan and More (2002). A run that is in `runs.json` is kept, so
that some packages can have more seeds than others.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import signal
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from time import process_time
from typing import Any

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):  # before NumPy is loaded
    os.environ[name] = "1"

import limited  # noqa: E402
import numpy as np  # noqa: E402
import pandas as pd  # noqa: E402
from peers import PEERS, LeftOutError  # noqa: E402

from grashof import load, synthesize  # noqa: E402
from grashof.analysis import verify  # noqa: E402
from grashof.analysis.judge.planted import planted_motion, planted_path  # noqa: E402
from grashof.problems import Linkage, Problem, Requirements, Rotatability  # noqa: E402
from grashof.synth.theory.distinct import pick_apart, signatures  # noqa: E402

NEAR, EXACT, APART = 1.01, 1e-6, 0.05
PACKAGES = ("grashof", "scipy", "pymoo", "fourbarhinge", "pylinkage")
OVERTIME = 3.0  # budgets after which a package is stopped in the middle of a call


def tasks() -> dict[str, Problem]:
    """All tasks, without data for ranking alone, such as masses."""
    rng = np.random.default_rng(17)
    found = {name: load(name) for name in ("luggage", "path-8-points", "path-18-timed", "path-ellipse")}
    found["six-point line"] = load("path-vertical-line")
    poses, points = planted_motion(rng, poses=5)[0], planted_path(rng, points=9)[0]
    found["five planted poses"] = Problem(
        task=poses, requirements=Requirements(rotatability=Rotatability.ANY)
    )
    found["nine planted points"] = Problem(task=points)
    stated = {each["name"]: each["toml"] for each in limited.tasks(limited.KNOWN)}
    for name, of in (("knee, limited", "knee"), ("leg, limited", "leg_tight"), ("moon, limited", "shb_moon")):
        found[name] = limited.problem_of(stated[of], name)
    found |= {name: load(name) for name in ("function-five-pairs", "function-sin", "function-log10")}
    return {name: replace(each, dynamics=None) for name, each in found.items()}


def judged(problem: Problem, linkage: Linkage) -> float:
    """The error of a linkage that meets all requirements, length or rad; infinite for others.

    Exactness is required afterwards, so least squares counts here by its error. The greatest error of a
    function is that over the full range, not at the pairs alone.
    """
    task, wanted = problem.task, replace(problem.requirements, exact=False)
    verdict = verify(linkage, task, wanted)
    if not verdict.ok:
        return np.inf
    if task.norm == "max" and not is_exact(problem):
        return verdict.structural_error_max
    return float(np.sqrt(verdict.square / len(task)))


def run(peer: str, problem: Problem, seed: int, budget: float) -> dict[str, Any]:
    """The linkages that a package finds, and the times."""
    found: list[tuple[float, Linkage]] = []
    begun = process_time()
    signal.setitimer(signal.ITIMER_PROF, OVERTIME * budget)
    try:
        PEERS[peer](problem, seed, budget, lambda linkage: found.append((process_time() - begun, linkage)))
    except (LeftOutError, ModuleNotFoundError) as error:
        return {"left_out": str(error)}
    except (RuntimeError, ValueError, TimeoutError) as error:  # a package's own word for nothing found
        print(f"{peer}: {error}")
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
    spent = process_time() - begun
    errors = [judged(problem, linkage) for _, linkage in found]
    limit = limit_of(problem, min(errors, default=np.inf))
    good = [linkage for (_, linkage), error in zip(found, errors, strict=True) if error <= limit]
    apart = 0
    if good:
        order = -np.arange(len(good), dtype=float)
        apart = len(pick_apart(signatures(problem.task, good), order, APART, len(good)))
    return {
        "processor": spent, "times": [round(time, 4) for time, _ in found], "errors": errors,
        "returned": len(found), "usable": sum(map(bool, np.isfinite(errors))), "distinct": apart,
    }  # fmt: skip


def _stop(*_: object) -> None:
    raise TimeoutError(f"stopped after {OVERTIME:g} times its budget")


def is_exact(problem: Problem) -> bool:
    """Whether every target must be met."""
    return problem.requirements.is_exact(problem.task)


def limit_of(problem: Problem, least: float) -> float:
    """Greatest error of a design that counts: rounding of exact tasks, else 1 % above the least."""
    return EXACT * problem.task.size if is_exact(problem) else NEAR * least


def frame_of(runs: dict[str, Any], problems: dict[str, Problem]) -> pd.DataFrame:
    """A row for each run; `first`, s, is the processor time to the first design that counts, or infinite."""
    rows = []
    for key, one in runs.items():
        task, peer, seed = key.split("|")
        empty = {"processor": np.nan, "errors": [], "times": []}
        if task in problems:
            rows.append({"task": task, "peer": peer, "seed": seed, **empty, **one})
    frame = pd.DataFrame(rows)
    frame["least"] = frame["errors"].map(lambda errors: min(errors, default=np.inf))
    frame["size"] = frame["task"].map(lambda task: problems[task].task.size)
    best = frame.groupby("task")["least"].transform("min")
    limits = (limit_of(problems[task], least) for task, least in zip(frame["task"], best, strict=True))
    frame["first"] = [
        min((t for t, e in zip(times, errors, strict=True) if e <= limit), default=np.inf)
        for times, errors, limit in zip(frame["times"], frame["errors"], limits, strict=True)
    ]
    return frame


def table(frame: pd.DataFrame) -> str:
    """A row for each task and package.

    The time to the first design is that expected with restarts: the time that all seeds spend until then, or
    in vain, over the number of seeds with a design. The other values are medians over the seeds.
    """
    lines = [
        "| task | package | least error / size | first, s | in all, s | seeds | distinct | usable |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for (task, peer), done in frame.groupby(["task", "peer"], sort=False):
        kept = done.dropna(subset="processor")  # the others are left out
        if kept.empty:
            lines.append(f"| {task} | {peer} | - | - | - | - | - | - |")
            continue
        hit = int(np.isfinite(kept["first"]).sum())
        spent = np.minimum(kept["first"], kept["processor"]).sum()
        returned, medians = kept["returned"].sum(), kept[["processor", "distinct"]].median()
        lines.append(
            f"| {task} | {peer} | {(kept['least'] / kept['size']).min():.2g} | "
            f"{f'{spent / hit:.3g}' if hit else '-'} | {medians['processor']:.3g} | {hit} of {len(kept)} | "
            f"{medians['distinct']:g} | {100 * kept['usable'].sum() / max(returned, 1):.0f} % |"
        )
    return "\n".join(lines) + "\n"


def stages(problems: dict[str, Problem]) -> str:
    """Time of each stage of Grashof, wall seconds of the first seed."""
    seconds = {task: synthesize(problem, seed=0).seconds for task, problem in problems.items()}
    names = list(dict.fromkeys(name for each in seconds.values() for name in each))
    lines = [f"| task | {' | '.join(names)} |", "|---" * (len(names) + 1) + "|"]
    for task, each in seconds.items():
        cells = (f"{each[name]:.2f}" if name in each else "" for name in names)
        lines.append(f"| {task} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def draw_profile(frame: pd.DataFrame, path: Path) -> None:
    """Draw the share of runs that each package completes within a multiple of the time of the fastest one."""
    from matplotlib.figure import Figure

    times = frame.pivot_table(index=["task", "seed"], columns="peer", values="first", aggfunc="first")
    fastest = times.min(axis=1)
    figure = Figure(figsize=(7, 4.4), layout="constrained")
    axes = figure.add_subplot()
    factors = np.logspace(0, 4, 400)
    for peer in filter(times.columns.__contains__, PEERS):
        ratio = (times[peer] / fastest)[np.isfinite(fastest) & times[peer].notna()].to_numpy()
        if len(ratio):
            shares = [(ratio <= factor).mean() for factor in factors]
            axes.step(factors, shares, where="post", label=peer)
    axes.set(
        xscale="log", xlabel="times the processor time of the fastest", ylabel="share of runs", ylim=(0, 1.02)
    )
    axes.legend(fontsize=8, loc="center right")
    axes.grid(alpha=0.3)
    figure.savefig(path, dpi=120)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the chosen packages on the chosen tasks, and write the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("benchmark"))
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--budget", type=float, default=20.0, help="processor time of a run, s")
    parser.add_argument("--tasks", nargs="*", choices=list(tasks()), help="all by default")
    parser.add_argument("--packages", nargs="*", choices=list(PEERS), help="all by default")
    given = parser.parse_args(arguments)
    given.out.mkdir(exist_ok=True)
    signal.signal(signal.SIGPROF, _stop)
    file = given.out / "runs.json"
    runs: dict[str, Any] = json.loads(file.read_text()) if file.exists() else {}
    problems = {name: each for name, each in tasks().items() if given.tasks is None or name in given.tasks}
    peers = given.packages or list(PEERS)
    load("luggage")
    PEERS["Grashof"](tasks()["luggage"], 0, 1.0, lambda _: None)  # imports are not measured
    for seed in range(given.seeds):
        for task, problem in problems.items():
            for peer in peers:
                key = f"{task}|{peer}|{seed}"
                if key not in runs:
                    runs[key] = run(peer, problem, seed, given.budget)
                    file.write_text(json.dumps(runs))
    versions = ", ".join(f"{name} {_version(name)}" for name in PACKAGES)
    said = f"{platform.processor() or platform.machine()}, Python {platform.python_version()}; {versions}\n\n"
    frame = frame_of(runs, problems)
    said += table(frame)
    if "Grashof" in peers:
        said += f"\nStages of Grashof, s\n\n{stages(problems)}"
    (given.out / "table.md").write_text(said)
    draw_profile(frame, given.out / "profile.png")
    print(said)
    return 0


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


if __name__ == "__main__":
    raise SystemExit(main())

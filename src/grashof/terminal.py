"""What the terminal shows: progress while a search works, and the list to decide by."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar
from rich.table import Table

from grashof.problems import Problem
from grashof.problems.checks import counted
from grashof.synth import Candidate, Progress, Result
from grashof.synth.result import pareto_optimal

_ROWS = 12
_PIPED_WIDTH = 140
_WIDE = 100  # columns; narrower terminals get fewer digits


def console(*, stderr: bool = False) -> Console:
    """A console that does not fold its lines when it is piped, and marks nothing up by itself."""
    made = Console(stderr=stderr, highlight=False, markup=False)
    if not made.is_terminal:
        made.width = _PIPED_WIDTH
    return made


@contextmanager
def search_progress(name: str) -> Iterator[Callable[[Progress], None]]:
    """Something to give as `progress=`: a bar on a terminal, plain lines elsewhere; on stderr."""
    out = console(stderr=True)
    if not out.is_terminal:
        yield lambda step: out.print(f"{name}: {_step(step)}")
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[step]}"))
    with Bar(*columns, TimeElapsedColumn(), console=out, transient=True) as bar:
        task = bar.add_task(name, total=None, step="tracing dyads and judging pairs")

        def show(step: Progress) -> None:
            bar.update(task, completed=step.verified, total=step.enough, step=_step(step))

        yield show


def _step(step: Progress) -> str:
    return f"{step.verified} of {step.enough} designs verified, {step.solved} of {step.starts} starts solved"


def print_table(result: Result) -> None:
    """Print the best designs, with what an engineer decides by."""
    out = console()
    typer.echo(_heading(result))
    with out.capture() as captured:
        out.print(_table(result, digits=4 if out.width >= _WIDE else 3))
    for line in captured.get().splitlines():
        typer.echo(line.rstrip())


def _table(result: Result, digits: int) -> Table:
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    for name in ("#", "mu task\ndeg", "mu turn\ndeg", "size", "r1", "r2", "r3", "r4"):
        table.add_column(name, justify="right", no_wrap=True)
    for name in ("O2", "O4"):
        table.add_column(name, justify="center", no_wrap=True)
    mixed = len(_classes(result)) > 1
    if mixed:
        table.add_column("class")
    front = pareto_optimal(result.problem, result.candidates)
    for rank, candidate in enumerate(result.candidates[:_ROWS], start=1):
        kind = [str(candidate.verdict.grashof_class)] if mixed else []
        table.add_row(f"{rank}{'*' if front[rank - 1] else ' '}", *_cells(candidate, digits), *kind)
    return table


def _heading(result: Result) -> str:
    worst = max(candidate.verdict.error_max for candidate in result.candidates)
    classes = _classes(result)
    kind = f"{classes.pop()} design" if len(classes) == 1 else "design"
    unit = result.problem.length_unit
    lengths = f" Lengths in {unit}." if unit else ""
    shown = f" The best {_ROWS}:" if len(result) > _ROWS else ""
    return (
        f"{counted(len(result), f'distinct verified {kind}')}, largest position error {worst:.1e}.{lengths}\n"
        f"mu: worst transmission angle; *: Pareto-optimal in mu and size.{shown}"
    )


def _classes(result: Result) -> set[str]:
    return {str(candidate.verdict.grashof_class) for candidate in result.candidates}


def _cells(candidate: Candidate, digits: int) -> list[str]:
    linkage, verdict = candidate.linkage, candidate.verdict
    task, turn = np.degrees([verdict.transmission_min_task, verdict.transmission_min_cycle])
    return [
        f"{task:.1f}",
        f"{turn:.1f}" if verdict.full_rotation else "-",
        f"{verdict.size:.{digits}g}",
        *(f"{length:.{digits}g}" for length in linkage.lengths),
        *(f"{x:.3g}, {y:.3g}" for x, y in (linkage.o2, linkage.o4)),
    ]


def summary(problem: Problem) -> list[str]:
    """A problem in a few lines, with the requirements as they will be applied."""
    task, wanted = problem.task, problem.requirements.resolved(problem.task.size)
    unit = f" {problem.length_unit}" if problem.length_unit else ""
    lengths = ", ".join(
        f"r{i} {low:g} to {high:g}" for i, (low, high) in enumerate(wanted.link_lengths, start=1)
    )
    arms = wanted.coupler_arms or (0.0, np.inf)
    lines = [
        f"{problem.name}: {problem.title}" if problem.title else problem.name,
        f"  motion through {len(task)} poses, size {task.size:g}{unit}, "
        f"angle_length {task.angle_length:g}{unit}",
        f"  rotatability {wanted.rotatability}, margin {wanted.rotatability_margin:g}; "
        f"order {_yes(wanted.order)}, same branch {_yes(wanted.same_branch)}",
        f"  transmission at least {wanted.transmission_min_deg:g} deg over the {wanted.transmission_over}",
        f"  links{unit and f' in{unit}'}: {lengths}; ratio up to {wanted.link_ratio_max:g}; "
        f"coupler arms {arms[0]:g} to {arms[1]:g}",
    ]
    for name in ("o2", "o4", "a", "b"):
        place = getattr(problem.requirements, name)
        if place is not None:
            lines.append(f"  {name}: x {place.x[0]:g} to {place.x[1]:g}, y {place.y[0]:g} to {place.y[1]:g}")
    angles = {key: getattr(wanted, key) for key in ("ground_angle_deg", "theta2_start_deg")}
    lines += [f"  {key} {value:g}" for key, value in angles.items() if value is not None]
    weights = problem.objective
    search = problem.search
    return [
        *lines,
        f"  objective: transmission {weights.transmission:g}, compactness {weights.compactness:g}",
        f"  search: up to {search.starts} starts, {search.enough} designs, seed {search.seed}",
    ]


def _yes(value: bool) -> str:
    return "yes" if value else "no"

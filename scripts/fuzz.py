"""Bad input at scale: mutated problem files, linkage files and lists, each valid or clearly refused.

    python scripts/fuzz.py                    # 10 000 mutants
    python scripts/fuzz.py --show FILE        # examine a finding again

Every mutant loads, or `ProblemError` states each error in a line of its own. A problem that loads
is the same when written and read again. A share of the problems, of up to a hundred targets, are
searched briefly, and every design is judged once more from its numbers alone; a share of the linkages are
reported on. Exit code 1: something was found.
"""

from __future__ import annotations

import argparse
import faulthandler
import json
import random
import signal
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType

from mutants import KINDS, Kind, Mutant, Mutator, Seed, linkage_seeds, list_seeds, problem_seeds, write_files

from grashof import load, synthesize
from grashof.analysis import verify
from grashof.output.analysis_files import write_report
from grashof.output.run_files import write_run
from grashof.problems import LinkageSpec, Problem, ProblemError, load_linkage_spec
from grashof.problems.files.linkage_file import load_design
from grashof.problems.files.problem_file import problem_of
from grashof.problems.files.problem_writing import problem_toml
from grashof.problems.values.specs.linkage_spec import ListedDesign
from grashof.study.asked import Asked
from grashof.study.on_request import ON_REQUEST
from grashof.survey import report_on
from grashof.synth import Result
from grashof.synth.search.finder import refuse_unsearchable
from grashof.wording.problem import summary
from grashof.workshop.formats import svg
from grashof.workshop.plan import plan_parts
from grashof.workshop.plates import PlateSizes
from grashof.workshop.sheet import sheet
from grashof.workshop.workbook import workbook

LOADING, WORKING = 5, 180  # s of processor time, after which it counts as a hang
MOST_TARGETS = 100  # of a task that is searched: the time grows with them
LONGEST = 1500  # characters of a line of an error, beside the name of the file
TRACEBACK, HANG, WRONG, UNCLEAR = "tracebacks", "hangs", "wrong designs", "unclear messages"
# Every option of an analysis; those that exclude each other, or need a certain kind, by themselves.
ASKED = (
    Asked(tolerance=0.01, sections=ON_REQUEST, at_deg=(0.0, 90.0)),
    Asked(balance=True, seconds=0.2),
    Asked(flywheel=0.1),
    Asked(release_deg=20.0, seconds=0.2),
    Asked(dwell_deg=2.0),
)
FINDINGS = (TRACEBACK, HANG, WRONG, UNCLEAR)
COUNTED = ("files", "refused", "accepted", "searched", "designs judged", "reports", *FINDINGS)
Work = Callable[[], bool]


class Finding(Exception):  # noqa: N818  (it is reported, too)
    """A property that a file violates: its kind, and the evidence."""

    def __init__(self, kind: str, what: str) -> None:
        super().__init__(what)
        self.kind, self.what = kind, what


class TooLongError(BaseException):
    """A limit of time is exceeded; no handler of errors catches it."""


def examine(path: Path, kind: Kind, figures: Counter[str], work: Work) -> Finding | None:
    """The property that a file violates, if any; `work` decides whether to search or report on it, too."""
    figures["files"] += 1
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            _examined(path, kind, figures, work)
    except Finding as found:
        return found
    except TooLongError:
        return Finding(HANG, traceback.format_exc())
    except Exception:  # noqa: BLE001  (any other error is a finding)
        return Finding(TRACEBACK, traceback.format_exc())
    return None


def _examined(path: Path, kind: Kind, figures: Counter[str], work: Work) -> None:
    loaded: list[Problem | LinkageSpec | ListedDesign]
    try:
        with _limit(LOADING):
            loaded = _loaded(path, kind)
    except ProblemError as error:
        figures["refused"] += 1
        _refuse_unclear(error, str(path))
        return
    figures["accepted"] += 1
    for one in loaded:
        if isinstance(one, Problem):
            _examine_problem(one, path.parent, figures, work)
        else:
            _examine_linkage(one, path.parent, figures, work)


def _loaded(path: Path, kind: Kind) -> list[Problem | LinkageSpec | ListedDesign]:
    if kind == "problem":
        return [load(path)]
    if kind == "linkage":
        return [load_linkage_spec(path)]
    spec, design = load_linkage_spec(f"{path}#1"), load_design(path, "1")
    return [spec, design, *([spec.problem] if spec.problem else [])]


def _refuse_unclear(error: ProblemError, where: str = "") -> None:
    lines = str(error).split("\n")
    for line in lines:
        words = line.removeprefix(where)
        if not words.strip() or len(words) > LONGEST or not words.isprintable() or (where and words == line):
            raise Finding(UNCLEAR, f"{type(error).__name__}: {line}")
    if len(set(lines)) < len(lines):
        raise Finding(UNCLEAR, f"a line comes twice: {error}")


def _examine_problem(problem: Problem, folder: Path, figures: Counter[str], work: Work) -> None:
    with _limit(LOADING):
        written = problem_toml(problem)
        if problem_toml(problem_of(written, "written", problem.name)) != written:
            raise Finding(WRONG, "the problem is another one when written and read again")
        summary(problem)
        try:
            refuse_unsearchable(problem)
        except ProblemError as error:
            _refuse_unclear(error)
            return
    if len(problem.task) > MOST_TARGETS or not work():
        return
    figures["searched"] += 1
    with _limit(WORKING):
        try:
            result = synthesize(problem, starts=4, enough=1, effort=0.2, time_limit=2.0)
        except ProblemError as error:
            _refuse_unclear(error)
            return
        _judge_again(result, figures)
        with tempfile.TemporaryDirectory(dir=folder) as out:
            write_run(Path(out), result, {}, drawings=0, problem_text=written)


def _judge_again(result: Result, figures: Counter[str]) -> None:
    problem = result.problem
    most = len(problem.task) * result.most_error**2 * (1 + 1e-9)  # NaN is no limit
    for design in result.candidates:
        figures["designs judged"] += 1
        linkage = type(design.linkage)(**json.loads(json.dumps(design.linkage.stated)))
        verdict = verify(
            linkage, problem.task, problem.requirements, problem=problem, cylinder=design.verdict.cylinder
        )
        if not verdict.ok or verdict.square > most:
            raise Finding(WRONG, f"{linkage!r}: {verdict.defects}, {verdict.square} against {most}")


def _examine_linkage(
    one: LinkageSpec | ListedDesign, folder: Path, figures: Counter[str], work: Work
) -> None:
    if not work():
        return
    spec = one.spec if isinstance(one, ListedDesign) else one
    figures["reports"] += 1
    with _limit(WORKING):
        try:
            workbook([one])
            svg(sheet(plan_parts(spec.linkage, PlateSizes(), 50.0 / float(spec.linkage.lengths.min()))))
        except ProblemError as error:
            _refuse_unclear(error)
        for asked in ASKED:
            try:
                report = report_on(spec, asked)
            except ProblemError as error:
                _refuse_unclear(error)
                continue
            if asked is ASKED[0]:
                with tempfile.TemporaryDirectory(dir=folder) as out:
                    write_report(Path(out), report)


@contextmanager
def _limit(seconds: float) -> Iterator[None]:
    """Interrupt after this processor time: a machine may be busy."""

    def stop(_signal: int, _frame: FrameType | None) -> None:
        raise TooLongError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


def seeds() -> list[Seed]:
    """The seeds of all mutants, the few linkages and lists more than once."""
    return [*problem_seeds(), *2 * linkage_seeds(), *3 * list_seeds()]


def fuzz(count: int, seed: int, share: float, out: Path, files: list[Seed]) -> Counter[str]:
    """Figures of `count` mutants; findings go into a folder, and a line of each to stdout."""
    rng = random.Random(seed)  # noqa: S311
    mutator, figures = Mutator(files, rng), Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        write_files(Path(folder))
        for number in range(count):
            mutant = mutator.mutant()
            path = Path(folder) / f"mutant{mutant.suffix}"
            path.write_bytes(mutant.content)
            # A hang in compiled code ends the program, with a traceback; the mutant then stays.
            faulthandler.dump_traceback_later(10 * WORKING, exit=True, file=sys.__stderr__ or 2)
            found = examine(path, mutant.kind, figures, lambda: rng.random() < share)
            if found is not None:
                figures[found.kind] += 1
                print(_kept(out, f"{mutant.kind}-{seed}-{number}", mutant, found), flush=True)
    faulthandler.cancel_dump_traceback_later()
    return figures


def _kept(out: Path, name: str, mutant: Mutant, found: Finding) -> str:
    out.mkdir(parents=True, exist_ok=True)
    write_files(out)
    path = out / f"{name}{mutant.suffix}"
    path.write_bytes(mutant.content)
    path.with_suffix(".txt").write_text(f"{found.kind}, {mutant.made_by}\n{found.what}\n", encoding="utf-8")
    return f"{path}: {found.kind}: {found.what.strip().splitlines()[-1][:200]}"


def main(arguments: list[str] | None = None) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("--mutants", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--share", type=float, default=0.1, help="share of loaded files to search or report")
    parser.add_argument("--out", type=Path, default=Path("fuzz-findings"), help="folder for findings")
    parser.add_argument("--show", type=Path, help="a finding to examine again; its name begins with its kind")
    given = parser.parse_args(arguments)
    if given.show:
        kind = next(kind for kind in KINDS if given.show.name.startswith(kind))
        found = examine(given.show, kind, Counter(), lambda: True)
        print("nothing wrong" if found is None else f"{found.kind}\n{found.what}")
        return int(found is not None)
    figures = fuzz(given.mutants, given.seed, given.share, given.out, seeds())
    for name in COUNTED:
        print(f"{name:18}{figures[name]:8}")
    return int(any(figures[kind] for kind in FINDINGS))


if __name__ == "__main__":
    sys.exit(main())

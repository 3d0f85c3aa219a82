"""The files of a sweep: the table as CSV and Parquet, the plot, the page, the record."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from grashof.output.folder import SWEEP_PAGE, SWEEP_RECORD, check_writable, own_files, replacing_own_files
from grashof.output.run_files import listed_files, versions_of, write_csv, write_json, write_page
from grashof.problems import ProblemError
from grashof.problems.files.on_disk import PACKAGES
from grashof.sweep.result import Sweep
from grashof.sweep.study import Study

TABLE, PARQUET, PLOT = "sweep.csv", "sweep.parquet", "sweep.png"
_ENGINES = ("pyarrow", "fastparquet")  # of pandas, in the order in which it tries them


def check_folder(folder: Path | None, study: Study) -> None:
    """Refuse (ProblemError), before any work, a folder or format that cannot be written."""
    if study.parquet and not any(map(find_spec, _ENGINES)):
        raise ProblemError(
            "parquet needs pyarrow: pip install 'grashof[parquet]' (in a clone '.[parquet]'), or leave it out"
        )
    if folder is not None:
        check_writable(folder, record=SWEEP_RECORD)


def record_of(done: Sweep, mark: str, *, complete: bool) -> dict[str, Any]:
    """The record of a sweep but for its files; `mark` is the fingerprint of the study in `Checkpoints`."""
    return {
        "study": mark,
        "name": done.study.name,
        "study_toml": done.study.text,
        "versions": versions_of((*PACKAGES, "pandas")),
        "designs_listed": done.study.designs,
        "complete": complete,
        "combinations": len(done.combinations),
        "tasks": len({(one.name, one.text) for one in done.combinations if one.text}),
        "done": len(done.results),
        "with_designs": done.with_designs,
        "invalid": done.invalid,
        "seconds": {
            "this_run": round(done.seconds, 3),
            "combinations": {
                str(number + 1): result["seconds"] for number, result in sorted(done.results.items())
            },
        },
    }


def write_sweep(folder: Path, done: Sweep, mark: str) -> None:
    """Write all files of a sweep; of one without any result the record alone."""
    record = record_of(done, mark, complete=done.complete)
    if not done.results:
        write_record(folder, record)
        return
    from grashof.figures.files import save  # matplotlib takes half a second to import
    from grashof.sweep.page import sweep_page
    from grashof.sweep.plot import plot_sweep

    frame = done.to_frame()
    with replacing_own_files(folder, record=SWEEP_RECORD) as fresh:
        write_csv(fresh / TABLE, frame)
        if done.study.parquet:
            frame.to_parquet(fresh / PARQUET, index=False)
        save(plot_sweep(done, frame), [fresh / PLOT])
        write_page(fresh / SWEEP_PAGE, sweep_page(done, frame, record))
        write_json(fresh / SWEEP_RECORD, {**record, "files": listed_files(fresh, SWEEP_RECORD)})


def write_record(folder: Path, record: Mapping[str, Any]) -> None:
    """Write the record of a sweep, and keep its other files."""
    before = own_files(folder, SWEEP_RECORD)
    with replacing_own_files(folder, keep=before, record=SWEEP_RECORD) as fresh:
        files = listed_files(fresh, SWEEP_RECORD, before)
        write_json(fresh / SWEEP_RECORD, {**record, "files": files})

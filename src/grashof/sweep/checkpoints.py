"""Finished tasks on disk: one JSON file each, whole or not there, and the record of the sweep they are of."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grashof.output.folder import SWEEP_RECORD, own_files, replacing_own_files
from grashof.output.run_files import write_json
from grashof.problems import ProblemError
from grashof.problems.files.on_disk import WRITING, versions, write_whole

RECORD = SWEEP_RECORD
TASKS = "tasks"
_OURS = re.compile(r"[0-9a-f]{32}\.json")
_SHAPE = {"status", "found", "note", "decides", "designs", "drawing", "seconds"}  # of a result


def fingerprint(combinations: Sequence[Any]) -> str:
    """Of a study: the cells and the task of each combination, in their order."""
    content = json.dumps(combinations, default=str)
    return hashlib.sha256(content.encode()).hexdigest()[:32]


@dataclass(frozen=True, slots=True)
class Checkpoints:
    """The finished tasks of a sweep in its folder."""

    folder: Path

    def read(self, study: str, keys: Collection[str], *, resume: bool) -> dict[str, dict[str, Any]]:
        """Results of the finished among the tasks `keys`, by task; leaves the disk alone.

        ProblemError where the folder holds an unfinished sweep and `resume` is False, or one of another
        fingerprint `study` or of other versions and it is True.
        """
        record = self._record()
        if not resume:
            if record is not None and not record["complete"]:
                raise ProblemError(
                    f"{self.folder}: holds an unfinished sweep, {len(self._files())} of {record['tasks']} "
                    "tasks done; --resume continues it, or name another folder"
                )
            return {}
        if record is None:
            if any(self._files()):
                raise ProblemError(f"{self.folder}: has tasks but no {RECORD}; name another folder")
            return {}
        self._refuse_other(record, study)
        return {path.stem: self._result(path) for path in self._files(keys)}

    def _refuse_other(self, record: dict[str, Any], study: str) -> None:
        theirs, ours = record["versions"], versions()
        changed = [
            f"{name} {theirs.get(name)} (now {mine})"
            for name, mine in ours.items()
            if theirs.get(name) != mine
        ]
        if changed:
            raise ProblemError(
                f"{self.folder}: holds a sweep made with {', '.join(changed)}; --resume needs the same "
                "versions, or name another folder"
            )
        if record["study"] != study:
            raise ProblemError(
                f"{self.folder}: holds a sweep of another study or of other options; --resume needs the "
                "same, or name another folder"
            )

    def _record(self) -> dict[str, Any] | None:
        """The record of the sweep in the folder; None where there is none."""
        path = self.folder / RECORD
        if not path.is_file():
            return None
        record = _content(path)
        kinds = {"complete": bool, "tasks": int, "versions": dict, "study": str}
        if not isinstance(record, dict) or not all(isinstance(record.get(k), t) for k, t in kinds.items()):
            raise ProblemError(f"{path}: is not the record of a sweep; name another folder")
        return record

    def _files(self, keys: Collection[str] | None = None) -> list[Path]:
        """Files of finished tasks; with `keys` any of another task is refused."""
        folder = self.folder / TASKS
        found = sorted(folder.glob("*.json")) if folder.is_dir() else []
        ours = [path for path in found if _OURS.fullmatch(path.name)]
        if keys is not None:
            known = set(keys)
            for path in ours:
                if path.stem not in known:
                    raise ProblemError(
                        f"{path}: is of another study or version; remove it, or name another folder"
                    )
        return ours

    def _result(self, path: Path) -> dict[str, Any]:
        content = _content(path)
        ours = isinstance(content, dict) and content.get("task") == path.stem
        result = content.get("result") if ours else None
        if not isinstance(result, dict) or not result.keys() >= _SHAPE:
            raise ProblemError(
                f"{path}: is not a finished task of this sweep; remove it to have it solved again"
            )
        return result

    def begin(self, record: dict[str, Any], kept: Collection[str]) -> None:
        """Make the folder, remove tasks of the last sweep but those kept, write the record of one begun."""
        tasks = self.folder / TASKS
        tasks.mkdir(parents=True, exist_ok=True)
        for path in tasks.iterdir():
            finished = _OURS.fullmatch(path.name) and path.stem not in kept
            if finished or path.name.startswith(WRITING):
                path.unlink()
        before = own_files(self.folder, RECORD)
        with replacing_own_files(self.folder, keep=before, record=RECORD) as fresh:
            write_json(fresh / RECORD, {**record, "files": sorted({*before, RECORD})})

    def write(self, key: str, result: dict[str, Any]) -> None:
        """Put a finished task on disk: to another name, flushed, renamed."""
        path = self.folder / TASKS / f"{key}.json"
        write_whole(path, {"task": key, "result": result})


def _content(path: Path) -> Any:
    """What a JSON file states; None where it cannot be read."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None

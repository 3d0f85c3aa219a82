"""Finished tasks on disk, a JSON file each, and the record of the sweep that they belong to."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grashof.output.folder import SWEEP_RECORD
from grashof.problems import ProblemError
from grashof.problems.files.on_disk import WRITING, versions, write_whole
from grashof.sweep.files import write_record

TASKS = "tasks"
_OURS = re.compile(r"[0-9a-f]{32}\.json")
_KINDS = {"complete": bool, "tasks": int, "versions": dict, "study": str}  # of a record
_RESULT = {"status", "found", "note", "decides", "designs", "drawing", "seconds"}  # keys of a result


def fingerprint(content: Sequence[Any]) -> str:
    """The same for the same content only: 32 hexadecimal digits."""
    return hashlib.sha256(json.dumps(content, default=str).encode()).hexdigest()[:32]


@dataclass(frozen=True, slots=True)
class Checkpoints:
    """The finished tasks of a sweep in its folder."""

    folder: Path

    def read(self, study: str, keys: Collection[str], *, resume: bool) -> dict[str, dict[str, Any]]:
        """Results of the finished among the tasks `keys`, by task; leaves the disk alone.

        ProblemError where the folder holds an unfinished sweep and `resume` is False, or one of another
        fingerprint `study` or of other versions and it is True.
        """
        record, files = self._record(), self._files()
        if not resume:
            if record is not None and not record["complete"]:
                raise ProblemError(
                    f"{self.folder}: holds an unfinished sweep, {len(files)} of {record['tasks']} "
                    "tasks done; --resume continues it, or name another folder"
                )
            return {}
        if record is None:
            if files:
                raise ProblemError(f"{self.folder}: has tasks but no {SWEEP_RECORD}; name another folder")
            return {}
        self._refuse_other(record, study)
        known = set(keys)
        if (other := next((path for path in files if path.stem not in known), None)) is not None:
            raise ProblemError(f"{other}: is of another study or version; remove it, or name another folder")
        return {path.stem: _result(path) for path in files}

    def _refuse_other(self, record: dict[str, Any], study: str) -> None:
        theirs = record["versions"]
        changed = [
            f"{name} {theirs.get(name)} (now {ours})"
            for name, ours in versions().items()
            if theirs.get(name) != ours
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
        path = self.folder / SWEEP_RECORD
        if not path.is_file():
            return None
        record = _content(path)
        if not isinstance(record, dict) or not all(isinstance(record.get(k), t) for k, t in _KINDS.items()):
            raise ProblemError(f"{path}: is not the record of a sweep; name another folder")
        return record

    def _files(self) -> list[Path]:
        """Files of finished tasks, sorted."""
        return sorted(path for path in (self.folder / TASKS).glob("*.json") if _OURS.fullmatch(path.name))

    def begin(self, record: dict[str, Any], kept: Collection[str]) -> None:
        """Make the folder, remove the tasks of the last sweep except those kept, and write a new record."""
        tasks = self.folder / TASKS
        tasks.mkdir(parents=True, exist_ok=True)
        old = [path for path in self._files() if path.stem not in kept]
        for path in (*old, *tasks.glob(f"{WRITING}*")):
            path.unlink()
        write_record(self.folder, record)

    def write(self, key: str, result: dict[str, Any]) -> None:
        """Put a finished task on disk, complete or not at all."""
        write_whole(self.folder / TASKS / f"{key}.json", {"task": key, "result": result})


def _result(path: Path) -> dict[str, Any]:
    content = _content(path)
    ours = isinstance(content, dict) and content.get("task") == path.stem
    result = content.get("result") if ours else None
    if not isinstance(result, dict) or not result.keys() >= _RESULT:
        raise ProblemError(f"{path}: is not a finished task of this sweep; remove it to have it solved again")
    return result


def _content(path: Path) -> Any:
    """The content of a JSON file; None where it cannot be read."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None

"""A log of a run in a file."""

from __future__ import annotations

import logging
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from grashof.output.folder import is_own_name
from grashof.output.process import say
from grashof.problems import ProblemError
from grashof.synth.search.journal import is_record_name

LAYOUT = "%(asctime)s.%(msecs)03dZ %(levelname)s %(name)s: %(message)s"


class _File(logging.FileHandler):
    """Reports once that it cannot be written any more: that never costs a result."""

    failed = False

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802, ARG002  (logging's name)
        error = sys.exc_info()[1]
        if not self.failed:
            reason = getattr(error, "strerror", None) or error
            say(f"--log {self.baseFilename}: {reason}; the log is incomplete", err=True)
        self.failed = True


@contextmanager
def logged(path: Path | None, folder: Path, record: Path) -> Iterator[None]:
    """Append the log of the block to a file, too: every start, time in UTC.

    ProblemError where it cannot be written, or is one of the run's own files in `folder` or `record`.
    """
    if path is None:
        yield
        return
    own = {folder.resolve(): is_own_name, record.resolve(): is_record_name}
    places = path.parent.resolve() / path.name, path.resolve()  # the last one is where a link leads
    if any(place.parent in own and own[place.parent](place.name) for place in places):
        raise ProblemError(f"--log {path}: the run writes this file itself; name another one")
    if path.suffix.lower() == ".toml":
        raise ProblemError(f"--log {path}: is a problem file by its name; name another one")
    try:
        file = _File(path, encoding="utf-8", errors="replace")
    except OSError as error:
        reason = error.strerror or "it cannot be written"
        raise ProblemError(f"--log {path}: {reason}; it must be a file that can be written") from None
    layout = logging.Formatter(LAYOUT, "%Y-%m-%dT%H:%M:%S")
    layout.converter = time.gmtime
    file.setFormatter(layout)
    logger = logging.getLogger("grashof")
    level = logger.level
    logger.addHandler(file)
    logger.setLevel(logging.DEBUG)
    try:
        yield
    finally:
        logger.setLevel(level)
        logger.removeHandler(file)
        with suppress(OSError):
            file.close()

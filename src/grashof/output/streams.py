"""Lines for people on stdout and stderr, which may be pipes that nobody reads to the end."""

from __future__ import annotations

import os
import re
import sys

import typer

from grashof.problems.values.checks import readable

_LAID_OUT = re.compile(r"[^\n\t]+")  # all but what lays out text


def say(line: str, *, err: bool = False) -> None:
    """Print a line; from the moment that nobody reads the stream any more (`| head`), nothing.

    Control characters, such as of file names, do not reach the terminal. OSError where stdout cannot be
    written, such as to a full disk; what is said on stderr never costs a result.
    """
    stream = sys.stderr if err else sys.stdout
    try:
        typer.echo(_LAID_OUT.sub(lambda found: readable(found[0]), line), err=err)
    except OSError as error:
        # Not only this line: what the stream still holds is flushed when the interpreter ends.
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
        if not (err or isinstance(error, BrokenPipeError)):
            raise OSError(f"standard output: {error.strerror}") from None

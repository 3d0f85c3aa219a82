"""The command line: its commands, and one line for each error."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from inspect import Signature, signature
from typing import Annotated, Any, get_type_hints

import typer
from typer.core import TyperGroup

from grashof import commands, searches
from grashof.options import JSON, parameters
from grashof.output.document import Document, print_document
from grashof.output.process import TRACEBACK, ExitCode, failure, say
from grashof.problems.values.errors import ProblemError, SolverError

# Typer makes the base of its usage errors public only through this one.
_UsageError: type[Exception] = typer.BadParameter.__bases__[0]


class _Commands(TyperGroup):
    """The commands, with one line for a usage error."""

    def main(self, args: Sequence[str] | None = None, *rest: Any, **options: Any) -> Any:
        given = list(sys.argv[1:] if args is None else args)
        if not given:  # the help
            return super().main(given, *rest, **options)
        try:
            code = super().main(given, *rest, **{**options, "standalone_mode": False})
        except _UsageError as error:
            message: str = getattr(error, "format_message", error.__str__)()
            words = f"{' '.join(message.split()).rstrip('.')}; see grashof --help"
            say(f"grashof: {words}", err=True)
            code = ExitCode.BAD_INPUT
            if JSON in given:
                print_document(Document(code, words))
        except OSError as error:  # of the help or the version: commands report their own
            say(f"grashof: {f'standard output: {error.strerror}' if error.strerror else error}", err=True)
            code = ExitCode.SURROUNDINGS
        except Exception as error:  # noqa: BLE001  (the outermost boundary: nothing else reports it)
            if os.environ.get(TRACEBACK):
                say(traceback.format_exc(), err=True)
            code, words = failure(error)
            say(f"grashof: {words}", err=True)
        sys.exit(code or ExitCode.OK)


app = typer.Typer(
    cls=_Commands,
    help="Find planar four-bar and six-bar linkages that do a job, verify them, and rank them.",
    no_args_is_help=True,
    add_help_option=False,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        say(f"grashof {version('grashof')}")
        raise typer.Exit


def _print_help(context: typer.Context, wanted: bool) -> None:
    if wanted:
        say(context.get_help())
        raise typer.Exit


@app.callback()
def grashof(
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print it and exit.")
    ] = False,
    # Typer's own has None as value where it is absent, and loads pydantic to check that.
    _help: Annotated[
        bool, typer.Option("--help", callback=_print_help, is_eager=True, help="Show this message and exit.")
    ] = False,
) -> None:
    """The command without a subcommand."""


def _register(run: Callable[..., ExitCode | None]) -> None:
    """Make a function a command; each field of the class of its `options`, if any, is an option."""
    hints = get_type_hints(run, include_extras=True)
    given = [each.replace(annotation=hints[each.name]) for each in signature(run).parameters.values()]
    own = [each for each in given if each.name != "options"]
    kept = parameters(hints["options"]) if "options" in hints else []

    @wraps(run)
    def command(**given: Any) -> None:
        with _reported_errors():
            if kept:
                given["options"] = hints["options"](**{each.name: given.pop(each.name) for each in kept})
            raise typer.Exit(run(**given) or ExitCode.OK)

    command.__signature__ = Signature([*own, *kept])  # type: ignore[attr-defined]
    app.command()(command)


for _run in (
    searches.solve,
    searches.merge,
    searches.sweep,
    commands.check,
    commands.prove,
    commands.judge,
    commands.show,
    commands.problems,
    commands.linkages,
    commands.schema,
    commands.analyse,
    commands.live,
    commands.animate,
    commands.export,
):
    _register(_run)  # in the order of the help


def main() -> None:
    """Entry point of the `grashof` command."""
    # Drawings go to files: a backend for windows, or a misspelt one, must not interfere.
    os.environ["MPLBACKEND"] = "agg"
    os.environ["PYDANTIC_DISABLE_PLUGINS"] = "1"  # the search for them reads every installed package
    app(prog_name="grashof")


@contextmanager
def _reported_errors() -> Iterator[None]:
    """Bad input and environment errors end the program with one line, not with a traceback."""
    try:
        yield
    except (ProblemError, SolverError, OSError, KeyboardInterrupt) as error:
        code, message = failure(error)
        for line in message.splitlines():
            say(f"grashof: {line}", err=True)
        raise typer.Exit(code) from None

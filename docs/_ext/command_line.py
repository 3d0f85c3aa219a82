"""The command line, from the commands themselves."""

from __future__ import annotations

import re
from typing import Any

import typer
from marking import row

from grashof.cli import app
from grashof.problems.schema.docstrings import code

_LITERAL = re.compile(r"(?<![\w`])(--[a-z][a-z-]*|DIR/[\w.\\#,]+)")


def commands_page() -> str:
    """Every command with its arguments and options, in Markdown."""
    group: Any = typer.main.get_command(app)
    above = typer.Context(group, info_name="grashof")
    return "\n\n".join(_command(name, each, above) for name, each in group.commands.items())


def _command(name: str, command: Any, above: typer.Context) -> str:
    here = typer.Context(command, info_name=name, parent=above)
    usage = re.sub(r"^Usage: ", "", command.get_usage(here)).replace("{", "").replace("}", "")
    records = [each.get_help_record(here) for each in command.params if each.name != "help"]
    rows = [row(code(left), _marked(right)) for left, right in filter(None, records)]
    table = "\n".join([row("argument or option", "meaning"), "|---|---|", *rows])
    return (
        f"## grashof {name}\n\n```text\n{' '.join(usage.split())}\n```\n\n{_marked(command.help)}\n\n{table}"
    )


def _marked(text: str) -> str:
    """Help text in Markdown: options, files and what stands in brackets as they are."""
    plain = text.replace("[", r"\[").replace("<", r"\<").replace("*", r"\*").replace("#", r"\#")
    return _LITERAL.sub(lambda found: code(found[1].replace("\\", "")), plain)

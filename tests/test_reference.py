"""The generated reference: every key, column, option and public name is there, and has a meaning."""

import re
import sys
from importlib import import_module
from inspect import isclass, isroutine
from pathlib import Path
from pkgutil import iter_modules

import typer

import grashof
from grashof.cli import app
from grashof.synth.designs.table import COLUMNS

DOCS = Path(__file__).parents[1] / "docs"
sys.path.append(str(DOCS / "_ext"))

import api  # noqa: E402
import columns  # noqa: E402
import command_line  # noqa: E402
import keys  # noqa: E402

from grashof.problems.schema.keys import described_keys, linkage_tables, problem_tables  # noqa: E402

FILES = {"problem": problem_tables, "linkage": linkage_tables, "study": keys.study_tables}
TABLES = [(f"{file}: {path}", table) for file, tables in FILES.items() for path, table in tables().items()]


def test_every_key_has_a_value_and_a_sentence() -> None:
    """One of its own, not that of a type of Python."""
    for path, table in TABLES:
        listed = described_keys(table)
        assert [key.name for key in listed] == list(table.model_fields), path  # type: ignore[attr-defined]
        assert all(key.value and key.text.endswith(".") for key in listed), path
        assert not any(re.match("Built-in|Represent", key.text) for key in listed), path


def test_rows_state_value_unit_and_default() -> None:
    for table, row in (
        ("requirements", "| `transmission_min_deg` | number, 0 to 90 | deg | `0` |"),
        ("requirements", "| `link_length` | [lo, hi], from 0 | length | 0.01 to 20 sizes of the task |"),
        ("requirements", '| `driver_sense` | `"either"`, `"ccw"`, `"cw"` |  | `"either"` |'),
        ("search", "| `starts` | whole number |  | `200` |"),
        ("springs[]", "| `stiffness` | number | N/m | required |"),
        ("strength", "| `yield_stress` | number | Pa | required |"),
    ):
        assert row in keys.key_table(problem_tables()[table])


def test_every_column_has_a_row() -> None:
    listed = re.findall(r"^\| `(\w+)` \|", columns.column_table(), re.MULTILINE)
    assert set(COLUMNS) <= set(listed)


def test_every_command_and_option_has_a_meaning() -> None:
    page = command_line.commands_page()
    for name, command in typer.main.get_command(app).commands.items():  # type: ignore[attr-defined]
        section = page.split(f"## grashof {name}\n")[1].split("\n## ")[0]
        rows = re.findall(r"^\| `([^`]+)` \| ([^|]+) \|$", section, re.MULTILINE)
        options = [each.opts[0] for each in command.params if each.param_type_name == "option"]
        assert [option for option in options if option not in {row[0].split()[0] for row in rows}] == []
        assert all(meaning.strip() for _, meaning in rows)


def test_every_public_package_has_a_page() -> None:
    packages = [each.name for each in iter_modules(grashof.__path__, "grashof.") if each.ispkg]
    packages += ["grashof.problems", "grashof.analysis", "grashof.synth"]
    public = {name for name in packages if getattr(import_module(name), "__all__", ())}
    assert public <= {each.name for each in api.PACKAGES}


def test_every_public_name_is_listed_and_has_a_docstring() -> None:
    for package in api.PACKAGES:
        listed = re.findall(r"^   (\w+)$", api.package_page(package), re.MULTILINE)
        names, module = api.public_names(package.name), import_module(package.name)
        assert sorted(listed) == sorted(names)
        values = {name: getattr(module, name) for name in names}
        functions = {name: each for name, each in values.items() if isclass(each) or isroutine(each)}
        assert [name for name, each in functions.items() if not each.__doc__] == []


def test_every_example_is_short_and_has_a_title() -> None:
    for path in (DOCS / "gallery").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert len(text.splitlines()) <= 90, path.name
        assert re.match(r'"""\n.+\n=+\n', text), path.name

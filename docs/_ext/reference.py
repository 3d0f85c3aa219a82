"""Sphinx extension: writes the generated pages of the reference before the build reads its sources."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Callable, Mapping
from importlib import import_module
from itertools import groupby
from pathlib import Path

from api import PACKAGES, homes, index_page, package_page
from columns import column_table
from command_line import commands_page
from keys import key_table, study_tables
from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.pycode import ModuleAnalyzer

from grashof.problems.files.place_schema import BoxTable
from grashof.problems.files.tables import Table
from grashof.problems.schema.docstrings import code
from grashof.problems.schema.keys import linkage_tables, problem_tables

FOLDER = Path("reference", "generated")  # below docs; not in the repository


def pages() -> dict[str, str]:
    """The generated files of the reference by name, inserted into its pages or pages themselves."""
    own = {f"api/{each.page}.rst": package_page(each) for each in PACKAGES}
    return own | {
        "api/index.rst": index_page(),
        "problem-keys.md": _tables(problem_tables()),
        "linkage-keys.md": _tables(linkage_tables()),
        "study-keys.md": _tables(study_tables()),
        "columns.md": column_table(),
        "commands.md": commands_page(),
    }


def _tables(tables: dict[str, type[Table]]) -> str:
    """A section for each table of a file; tables of the same shape share one, places come last."""
    ordered = sorted(tables.items(), key=lambda each: each[1] is BoxTable)
    sections = []
    for table, group in groupby(ordered, key=lambda each: each[1]):
        paths = [path for path, _ in group]
        named = [_heading(path) for path in paths]
        if table is BoxTable:
            sections.append(f"## Places\n\n{', '.join(named)}:\n\n{key_table(table)}")
        else:
            heading = ", ".join(named) if any(paths) else "The file"
            sections.append(f"## {heading}\n\n{key_table(table)}")
    return "\n\n".join(sections)


def _heading(path: str) -> str:
    """A table as a file has it."""
    if "=" in path:  # the file itself, of a kind of linkage
        return code(path)
    inside, plain = "." in path, path.replace("[]", "")
    return code(f"[[{plain}]]" if path.endswith("[]") and not inside else f"[{plain}]")


def write(app: Sphinx, _config: Config) -> None:
    """Write the files, those that changed, so that nothing else is built anew."""
    for name, text in pages().items():
        path = Path(app.srcdir) / FOLDER / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def marked(line: str, names: Mapping[str, str]) -> str:
    r"""A line of a docstring in reStructuredText: bars are bars, and public names link to their pages.

    Examples
    --------
    >>> marked("``|x|`` or |y| of a `Task` at `theta2`", {"Task": "grashof.problems.Task"})
    '``|x|`` or \\|y\\| of a :py:obj:`~grashof.problems.Task` at ``theta2``'
    """
    if line.lstrip().startswith((">>>", "...")):
        return line
    return _PIECE.sub(lambda found: _piece(found, names), line)


_PIECE = re.compile(r"``.+?``|(?<![\w:`])`(?P<name>[^`<>]+)`(?![`_])|\|")


def _piece(found: re.Match[str], names: Mapping[str, str]) -> str:
    if found[0] == "|":
        return r"\|"
    name = found["name"]
    if name is None:
        return found[0]
    return f":py:obj:`~{names[name]}`" if name in names else f"``{name}``"


def constant_text(name: str) -> list[str]:
    """The comment ``#:`` above a constant or type, by its full name, wherever it is defined."""
    package, _, short = name.rpartition(".")
    source = inspect.getsource(import_module(package))
    homes = [
        node.module
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ImportFrom) and any(alias.name == short for alias in node.names)
    ]
    found = ModuleAnalyzer.for_module(homes[0] or package if homes else package).find_attr_docs()
    return list(found.get(("", short), []))


def _mark(names: Mapping[str, str]) -> Callable[..., None]:
    def mark(_app: Sphinx, what: str, name: str, _obj: object, _options: object, lines: list[str]) -> None:
        if what == "data":  # its type's docstring otherwise
            lines[:] = constant_text(name)
        lines[:] = [marked(line, names) for line in lines]

    return mark


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the pages once the configuration is read; mend docstrings before numpydoc reads them."""
    app.connect("config-inited", write)
    app.connect("autodoc-process-docstring", _mark(homes()), priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""Count what knows the kinds of linkage: files that ask for the kind, and bodies of the loop's closure.

A file asks when it compares a kind (`MECHANISM`, `mechanism`, `FOUR_BAR` ..., a class of linkage, or
`type(linkage)`), looks something up by it, keys or lists a table by it, matches it, dispatches by the
annotation of a registered function, or uses `isinstance`, `kind_of`, `KINDS` or `SLIDES`. Names are followed
through imports: other things of these names do not count. Imports, annotations and the construction of a
linkage do not ask. A file that only hands the word on, to a function, a file, a column or a message, is
counted apart. The values themselves may ask.

Bodies of the closure carry a mark, `# closure: RRR` (RRP, RPR, or several): code that finds links 3 and 4, or
the slide, from the driver angle. Nothing else shows them all: some fix the assembly, one leaves the root to
Ipopt, one is text for GeoGebra. A function that takes a root and names the assembly without a mark is a
suspect. Most suspects find something else, such as limit positions; a new one has to be looked at.

Not seen: a kind that is told by what it has (`hasattr`, `"o4" in ground`, the `kinds` of a quantity, the
`slides` of a row, the kind of its dyads) or by a function that tells it (`is_of`, `closing_dyad`), or that is
held in a variable of another name, and kinds in JavaScript but for marks.
"""

import argparse
import ast
import json
import re
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from kinds_asked import HOME, Asking, Scope, last
from source_tree import FOLDERS, ROOT, circle_of_modules, circle_of_rooms, name_of

LAYERS = (*FOLDERS, "src/grashof", "scripts")
MARK = re.compile(r"(?:#|//) closure: ((?:RRR|RRP|RPR)(?:, (?:RRR|RRP|RPR))*)$", re.MULTILINE)
ROOTS = frozenset({"sqrt", "arccos", "acos", "arcsin", "asin", "root"})
ASSEMBLY = frozenset({"assembly", "sign", "branch"})
LONGEST, FULLEST = 400, 20  # lines of a file, files of a folder


def closures(text: str) -> list[str]:
    """Dyads of the bodies of the closure that a text marks."""
    return [dyad for each in MARK.findall(text) for dyad in each.split(", ")]


def suspects(tree: ast.Module, text: str) -> list[str]:
    """Functions without a mark that take a root and name the assembly."""
    lines, found = text.splitlines(), []
    for function in (each for each in ast.walk(tree) if isinstance(each, ast.FunctionDef)):
        nodes = list(_own(function))
        called = {id(node.func): last(node.func) for node in nodes if isinstance(node, ast.Call)}
        used = (
            node.arg if isinstance(node, ast.arg) else last(node) for node in nodes if id(node) not in called
        )
        unmarked = not closures("\n".join(lines[function.lineno - 1 : function.end_lineno]))
        if unmarked and ROOTS & {*called.values()} and ASSEMBLY & {*used}:
            found.append(function.name)
    return found


def _own(node: ast.AST) -> Iterator[ast.AST]:
    """Nodes of a function, without those of functions and classes inside."""
    for child in ast.iter_child_nodes(node):
        yield child
        if not isinstance(child, ast.FunctionDef | ast.ClassDef):
            yield from _own(child)


def read(folder: str, ending: str = "py") -> dict[str, str]:
    """Texts of all files in a folder by their paths from the root."""
    paths = sorted((ROOT / folder).rglob(f"*.{ending}"))
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def counted() -> dict[str, Any]:
    """What is behind the figures: by layer and file, by folder, or by name."""
    texts = {layer: read(layer) for layer in LAYERS}
    trees = {where: ast.parse(text) for files in texts.values() for where, text in files.items()}
    # Scripts import one another by their bare names.
    names = {
        where: Path(where).stem if where.startswith("scripts/") else name_of(ROOT / where) for where in trees
    }
    scopes = {names[where]: Scope(tree) for where, tree in trees.items()}
    found: dict[str, Any] = {what: {} for what in ("asks", "passes", "closures", "suspects")}
    for layer, files in texts.items():
        asking = {
            where: Asking(scopes[names[where]], scopes) for where in files if not HOME.match(names[where])
        }
        for where, one in asking.items():
            one.visit(trees[where])
        marked = files | (read(layer, "js") if layer.startswith("src") else {})
        figures: dict[str, dict[str, Any]] = {
            "asks": {where: one.asks for where, one in asking.items()},
            "passes": {where: one.passes for where, one in asking.items() if not one.asks},
            "closures": {where: closures(text) for where, text in marked.items()},
            "suspects": {where: suspects(trees[where], text) for where, text in files.items()},
        }
        for what, by_file in figures.items():
            found[what][layer] = {where: value for where, value in by_file.items() if value}
    texts["tests"] = read("tests")
    sizes = {where: len(text.splitlines()) for files in texts.values() for where, text in files.items()}
    folders = Counter(Path(where).parent.as_posix() for where in sizes)
    return found | {
        "lines": {layer: sum(sizes[where] for where in files) for layer, files in texts.items()},
        "full": {folder: count for folder, count in folders.items() if count > FULLEST},
        "long": {where: size for where, size in sizes.items() if size > LONGEST},
        "circles": {"files": circle_of_modules(), "rooms": circle_of_rooms()},
    }


def totals(found: dict[str, Any]) -> dict[str, dict[str, int]]:
    """The figures, by layer where they have one."""
    return {
        **{what: {layer: len(files) for layer, files in found[what].items()} for what in ("asks", "passes")},
        **{
            what: {layer: sum(map(len, files.values())) for layer, files in found[what].items()}
            for what in ("closures", "suspects")
        },
        "lines": found["lines"],
        "circles": {what: len(names) for what, names in found["circles"].items()},
        "large": {what: len(found[what]) for what in ("full", "long")},
    }


def main(argv: Sequence[str] | None = None) -> int:
    """Print the figures by layer, or with `--json` all that is behind them."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--json", action="store_true", help="files, lines and functions behind the figures")
    asked = parser.parse_args(argv)
    found = counted()
    if asked.json:
        print(json.dumps(found, indent=1))
        return 0
    figures = totals(found)
    columns = ("asks", "passes", "closures", "suspects", "lines")
    print(f"{'':12}" + "".join(f"{what:>10}" for what in columns))
    for layer in found["lines"]:
        print(f"{layer:12}" + "".join(f"{figures[what].get(layer, ''):>10}" for what in columns))
    for layer, files in found["closures"].items():
        dyads = Counter(dyad for each in files.values() for dyad in each)
        print(
            f"closures in {layer}: {', '.join(f'{count} {dyad}' for dyad, count in dyads.items()) or 'none'}"
        )
    for what, names in found["circles"].items():
        print(f"{what} in circles of imports: {', '.join(names) or 'none'}")
    for what, large in (
        ("full", f"folders of more than {FULLEST} files"),
        ("long", f"files above {LONGEST} lines"),
    ):
        print(f"{large}: {', '.join(f'{name} {size}' for name, size in found[what].items()) or 'none'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

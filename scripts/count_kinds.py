"""Count the code that knows the kinds of linkage: files that ask for the kind, bodies of the loop's closure.

A file asks when it compares a kind (a class of linkage, its word or `mechanism`, `type(linkage)`), looks
something up by it, keys or lists a table by it, matches it, or dispatches by it (`isinstance`, `kind_of`,
registered functions). Imports, annotations, the construction of a linkage and handing the word on do not ask,
nor does code that looks at features (`slides`, `"o4" in ground`). The values themselves may ask.

Bodies of the closure carry a mark, `# closure: RRR` (RRP, RPR, or several): code that finds links 3 and 4, or
the slide, from the driver angle. Nothing else shows them all: some fix the assembly, one leaves the root to
Ipopt, one is text for GeoGebra. A function that takes a root and names the assembly without a mark is a
suspect. Most suspects find something else, such as limit positions; a new one has to be examined.
"""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from source_tree import FOLDERS, ROOT, circle_of_modules, circle_of_rooms

LAYERS = (*FOLDERS, "src/grashof", "scripts")
HOME = "problems/values/linkages/"  # the room of the linkages as values
CLASSES = frozenset({"FourBar", "SliderCrank", "InvertedSliderCrank", "SixBar"})
WORDS = frozenset({
    "four-bar", "slider-crank", "inverted-slider-crank", "six-bar", "watt-1", "watt-2", "stephenson-1",
    "stephenson-3",
})  # fmt: skip
CONSTANTS = frozenset({"FOUR_BAR", "SLIDER_CRANK", "INVERTED"})
MARK = re.compile(r"(?:#|//) closure: ((?:RRR|RRP|RPR)(?:, (?:RRR|RRP|RPR))*)$", re.MULTILINE)
ROOTS = frozenset({"sqrt", "arccos", "acos", "arcsin", "asin", "root"})
ASSEMBLY = frozenset({"assembly", "sign", "branch"})
LONGEST, FULLEST = 400, 20  # lines of a file, files of a folder
_LISTS = ast.Tuple | ast.List | ast.Set


def last(node: ast.AST | None) -> str:
    """Last part of a dotted name, or of the table of an index; empty for anything else."""
    if isinstance(node, ast.Subscript):
        return last(node.value)
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def is_kind(node: ast.AST) -> bool:
    """Whether an expression stands for a kind, or is a list or a union with one."""
    match node:
        case ast.Tuple(elts=parts) | ast.List(elts=parts) | ast.Set(elts=parts):
            return any(map(is_kind, parts))
        case ast.BinOp(left=left, right=right):
            return is_kind(left) or is_kind(right)
        case ast.Constant(value=str(text)):
            return text in WORDS | CLASSES
        case ast.Call(func=ast.Name("type"), args=[one]) | ast.Attribute(value=one, attr="__class__"):
            return "linkage" in last(one) or is_kind(one)
        case ast.Attribute(value=one, attr="__name__"):
            return is_kind(one)
    return last(node) in CLASSES | CONSTANTS | {"mechanism"}


def asks(tree: ast.AST) -> dict[str, list[int]]:
    """The ways in which a source asks for the kind, with the lines."""
    found: dict[str, list[int]] = {}
    for node in ast.walk(tree):
        for way, parts in _questions(node):
            if any(map(is_kind, parts)):
                found.setdefault(way, []).append(getattr(node, "lineno", 0))
    return found


def _questions(node: ast.AST) -> Iterator[tuple[str, list[Any]]]:
    """How a node asks, and the expressions that have to stand for a kind."""
    match node:
        case ast.Call(func=ast.Name("isinstance" | "issubclass"), args=[one, classes]):
            constant = "linkage" in last(one) and last(classes).isupper()
            yield "isinstance", [ast.Constant("FourBar") if constant else classes]
        case ast.Compare(left=left, comparators=others):
            yield "compared", [left, *others]
        case ast.Call(func=ast.Attribute(value=value, attr="startswith" | "endswith")):
            yield "compared", [value]
        case ast.Match(subject=subject):
            yield "match", [subject]
        case ast.MatchValue(value=value) | ast.MatchClass(cls=value):
            yield "match", [value]
        case ast.Call(func=ast.Attribute(attr="get" | "setdefault" | "pop" | "fromkeys"), args=[key, *_]):
            yield "key", [key]
        case ast.Dict(keys=keys):
            yield "key", [key for key in keys if key]
        case ast.DictComp(key=key):
            yield "key", [key]
        case ast.Subscript(slice=key, value=table) if last(table).isupper():
            yield "key", [key]
        case ast.Subscript(slice=key, value=table) if last(table).islower():  # not such as list[FourBar]
            yield "key", [key] if last(key) not in CLASSES and not isinstance(key, _LISTS | ast.BinOp) else []
        case ast.Call(func=ast.Name("kind_of")):
            yield "table", [ast.Constant("FourBar")]
        case ast.For(iter=value) | ast.Assign(targets=[ast.Name()], value=value):
            lists = [each for each in _literals(value) if isinstance(each, _LISTS)]
            names = [part for each in lists for part in each.elts if last(part) != "mechanism"]
            yield "listed", [name for name in names if not isinstance(name, ast.Constant | _LISTS)]
        case ast.FunctionDef(decorator_list=[_, *_] as marks, args=arguments):
            stated = [*marks, *(each.annotation for each in arguments.args[:1] if each.annotation)]
            parts = [part for one in stated for part in ast.walk(one)]
            yield "register", parts if any(last(part) == "register" for part in parts) else []


def _literals(value: ast.AST) -> Iterator[ast.AST]:
    """A literal and those inside it, tables of tables."""
    yield value
    if isinstance(value, _LISTS | ast.Dict):
        for each in value.values if isinstance(value, ast.Dict) else value.elts:
            yield from _literals(each)


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


def counted() -> dict[str, dict[str, dict[str, Any]]]:
    """Files that ask, closures, suspects, by layer and file; circles of imports; large folders and files."""
    found: dict[str, dict[str, dict[str, Any]]] = {what: {} for what in ("asks", "closures", "suspects")}
    sizes = {where: text.count("\n") for where, text in read("tests").items()}
    for layer in LAYERS:
        texts = read(layer)
        sizes |= {where: text.count("\n") for where, text in texts.items()}
        trees = {where: ast.parse(text) for where, text in texts.items()}
        marked = texts | (read(layer, "js") if layer.startswith("src") else {})
        by_file: dict[str, dict[str, Any]] = {
            "asks": {where: asks(tree) for where, tree in trees.items() if not where.startswith(HOME)},
            "closures": {where: closures(text) for where, text in marked.items()},
            "suspects": {where: suspects(trees[where], text) for where, text in texts.items()},
        }
        for what, every in by_file.items():
            found[what][layer] = {where: value for where, value in every.items() if value}
    folders = Counter(Path(where).parent.as_posix() for where in sizes)
    return found | {
        "circles": {
            "files": dict.fromkeys(circle_of_modules()), "rooms": dict.fromkeys(circle_of_rooms())
        },
        "large": {
            "full": {folder: count for folder, count in folders.items() if count > FULLEST},
            "long": {where: size for where, size in sizes.items() if size > LONGEST},
        },
    }  # fmt: skip


def totals(found: dict[str, dict[str, dict[str, Any]]]) -> dict[str, dict[str, int]]:
    """The figures: numbers of files that ask, circles and large things, else the count of each file."""
    of_files = ("asks", "circles", "large")
    return {
        what: {
            group: len(files) if what in of_files else sum(map(len, files.values()))
            for group, files in groups.items()
        }
        for what, groups in found.items()
    }


def main() -> int:
    """Print the figures, and the names behind them."""
    found = counted()
    for what, figures in totals(found).items():
        for group, figure in figures.items():
            names = (f"{name} {value or ''}".strip() for name, value in found[what][group].items())
            print(f"{what}, {group}: {figure}", *names, sep="\n    ")
    return 0


if __name__ == "__main__":
    sys.exit(main())

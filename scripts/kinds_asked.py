"""How a source asks for the kind of linkage, read from its syntax; `count_kinds.py` says what counts."""

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

CLASSES = frozenset({"FourBar", "SliderCrank", "InvertedSliderCrank", "SixBar"})
WORDS = frozenset({"four-bar", "slider-crank", "inverted-slider-crank", "six-bar"}) | {
    *("watt-1", "watt-2", "stephenson-1", "stephenson-3")
}
NAMES = {
    **dict.fromkeys(CLASSES, "class"),
    **dict.fromkeys(("FOUR_BAR", "SLIDER_CRANK", "INVERTED"), "word"),
    **dict.fromkeys(("KINDS", "kind_of"), "table"),
}
HOME = re.compile(r"grashof\.problems\.values\.linkages(\.|$)")  # the room of the linkages as values
_LISTS = ast.Tuple | ast.List | ast.Set
_HANDED = ast.Call | ast.keyword | ast.arguments | ast.Return | ast.FormattedValue | ast.AnnAssign


def last(node: ast.AST | None) -> str:
    """Last part of a dotted name, or of what an index is taken of; empty of anything else."""
    if isinstance(node, ast.Subscript):
        return last(node.value)
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


class Scope:
    """Where the names of a module come from, and which of its own stand for kinds of linkage."""

    def __init__(self, tree: ast.Module) -> None:
        self.taken, self.own = dict[str, tuple[str, str]](), set[str]()
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                self.taken |= {one.asname or one.name: (node.module or "", one.name) for one in node.names}
            elif isinstance(node, ast.Import):
                parts = {one.asname or one.name: one.name.rpartition(".") for one in node.names}
                self.taken |= {name: (part[0], part[2]) for name, part in parts.items()}
        for node in tree.body:
            if isinstance(node, ast.FunctionDef):
                self.own.add(node.name)
            elif isinstance(node, ast.Assign | ast.AnnAssign) and _of_kinds(node.value):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                names = [each for target in targets for each in ast.walk(target)]
                self.own |= {each.id for each in names if isinstance(each, ast.Name)}

    def meant(self, name: str, scopes: Mapping[str, "Scope"]) -> str:
        """Class, word or table of kinds that a name stands for where it is defined; empty for none."""
        module, origin = self.taken.get(name, ("", name))
        if not module:
            return NAMES.get(name, "") if name in self.own else ""
        elsewhere = scopes.get(module, self)  # a package may import a module of its own from itself
        if elsewhere is not self and not HOME.match(module):
            return elsewhere.meant(origin, scopes)
        return NAMES.get(origin, "") if module.startswith("grashof") else ""


def _of_kinds(value: ast.expr | None) -> bool:
    """Whether a constant is made of kinds; a linkage that is constructed is not."""
    if value is None or (isinstance(value, ast.Call) and last(value.func) in CLASSES):
        return False
    return any(
        last(part) in NAMES
        or last(part).startswith((*CLASSES, "Inverted"))
        or (isinstance(part, ast.Constant) and part.value in WORDS)
        for part in ast.walk(value)
    )


@dataclass
class Asking:
    """The ways in which a file asks, and the lines where it hands the word on."""

    scope: Scope
    scopes: Mapping[str, Scope]
    asks: dict[str, list[int]] = field(default_factory=dict)
    passes: list[int] = field(default_factory=list)
    above: list[ast.AST] = field(default_factory=list)

    def visit(self, node: ast.AST) -> None:
        """Note down how a node, and all below it, ask for the kind."""
        what = self.what(node)
        if way := what and self.way(node, what):
            self.asks.setdefault(way, []).append(getattr(node, "lineno", 0))
        elif what in ("word", "MECHANISM", "mechanism"):
            self.passes.append(getattr(node, "lineno", 0))
        self.above.append(node)
        for child in ast.iter_child_nodes(node):
            self.visit(child)
        self.above.pop()

    def what(self, node: ast.AST) -> str:
        """What a node stands for: a group of `NAMES`, an attribute of a linkage, ...; empty for none."""
        name = last(node)
        match node:
            case ast.FunctionDef(decorator_list=[_, *_]):
                return "register" if _registered(node) else ""
            case ast.Constant(value=str(text)):
                return "text" if text in WORDS | CLASSES else ""
            case ast.Call(func=ast.Name("type"), args=[one]) | ast.Attribute(value=one, attr="__class__"):
                return "type" if "linkage" in last(one) else ""
            case ast.Call(func=ast.Name("isinstance"), args=[one, classes]):
                return "isinstance" if "linkage" in last(one) and last(classes).isupper() else ""
            case ast.Attribute(value=value, ctx=ast.Load()):
                if name in ("MECHANISM", "mechanism", "SLIDES"):
                    of_class = self.scope.meant(last(value), self.scopes) == "class"
                    return "word" if of_class and name == "MECHANISM" else name
                module = ".".join(self.scope.taken.get(last(value), ()))
                return self.scopes[module].meant(name, self.scopes) if module in self.scopes else ""
            case ast.Name(ctx=ast.Load()):
                return name if name == "mechanism" else self.scope.meant(name, self.scopes)
        return ""

    def way(self, node: ast.AST, what: str) -> str:
        """How a file asks with what stands for a kind, by what that stands in; empty where it does not."""
        if what in ("table", "SLIDES", "register", "isinstance"):
            return what
        listed, parent = False, node
        for parent in reversed(self.above):
            within = isinstance(parent, _LISTS | ast.BoolOp | ast.Starred)
            union = isinstance(parent, ast.BinOp) and what == "class"
            first = isinstance(parent, ast.Subscript) and parent.value is node and what == "mechanism"
            chosen = isinstance(parent, ast.IfExp) and parent.test is not node
            named = isinstance(parent, ast.Attribute) and parent.attr == "__name__"
            if not (within or union or first or chosen or named):
                break
            listed |= isinstance(parent, _LISTS)
            node = parent
        match parent:
            case ast.Compare() | ast.If() | ast.IfExp() | ast.While() | ast.UnaryOp():
                return "compared"
            case ast.Attribute(attr="startswith" | "endswith"):
                return "compared"
            case ast.Match() | ast.MatchValue() | ast.MatchClass():
                return "match"
            case ast.Call(func=ast.Name("isinstance" | "issubclass"), args=[_, classes]) if classes is node:
                return "isinstance"
            case ast.Call(func=ast.Attribute(attr="get" | "setdefault" | "pop" | "fromkeys"), args=[key, *_]):
                return "key" if key is node else ""
            case ast.Dict(keys=keys) if node in keys:
                return "key"
            case ast.DictComp(key=key) if key is node:
                return "key"
            case ast.Subscript(slice=key, value=table) if key is node:
                constant = last(table).isupper()  # not such as Kind[FourBar] or Literal["four-bar"]
                return "key" if constant or (what != "class" and last(table).islower()) else ""
        names = what == "word" or (what == "class" and listed)
        return "listed" if names and not isinstance(parent, _HANDED) else ""


def _registered(function: ast.FunctionDef) -> bool:
    """Whether a function is that of a generic one for a class of linkage."""
    marks = [mark.func if isinstance(mark, ast.Call) else mark for mark in function.decorator_list]
    stated = [*function.decorator_list, *(each.annotation for each in function.args.args[:1])]
    parts = [part for one in stated if one for part in ast.walk(one)]
    return any(last(mark) == "register" for mark in marks) and any(last(part) in CLASSES for part in parts)

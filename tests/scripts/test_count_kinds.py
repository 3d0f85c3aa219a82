"""What knows the kinds of linkage by name is found, and does not grow."""

import ast
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

from grashof.problems import Linkage

# As counted when they were last lowered: they may only fall.
LIMITS = {
    "asks": {"problems": 1, "analysis": 1, "synth": 3, "src/grashof": 0, "scripts": 2},
    "closures": {"problems": 0, "analysis": 7, "synth": 6, "src/grashof": 6, "scripts": 7},
    "suspects": {"problems": 0, "analysis": 4, "synth": 11, "src/grashof": 0, "scripts": 1},
    "circles": {"files": 0, "rooms": 0},
    "large": {"full": 0, "long": 1},
}
HEAD = """
from grashof import problems
from grashof.problems import FourBar, InvertedSliderCrank, SliderCrank, FourBar as Bars
from grashof.problems.values.linkages.mechanisms import FOUR_BAR, INVERTED, KINDS
from grashof.analysis.loops.kinds import kind_of
"""
ASKING = {
    "isinstance(linkage, FourBar)": "isinstance",
    "not isinstance(spec.linkage, (FourBar, SliderCrank))": "isinstance",
    "isinstance(one, SliderCrank | InvertedSliderCrank)": "isinstance",
    "isinstance(one, Bars)": "isinstance",
    "isinstance(one.linkage, SLIDING)": "isinstance",
    "issubclass(kind, FourBar)": "isinstance",
    "type(one) is FourBar": "compared",
    "type(one.linkage) is kind": "compared",
    "type(linkages[0]) in (SliderCrank, InvertedSliderCrank)": "compared",
    "type(linkage).__name__ == kind": "compared",
    "one.__class__.__name__ == 'FourBar'": "compared",
    "linkage.__class__ is kind": "compared",
    "FORMULAS[type(linkage)](linkage)": "key",
    "formulas.get(type(linkage))": "key",
    "_FORMULAS[FourBar]": "key",
    "FORMULAS = {FourBar: 1}": "key",
    "FORMULAS: dict[type, int] = {FourBar.MECHANISM: 1, **more}": "key",
    "WORDS = {'slider-crank': 'stroke'}": "key",
    "WORDS[problem.mechanism[0]]": "key",
    "found[linkage.MECHANISM]": "key",
    "words.setdefault(linkage.MECHANISM, [])": "key",
    "{linkage.MECHANISM: linkage for linkage in every}": "key",
    "BOTH = (FOUR_BAR, INVERTED)": "listed",
    "BOTH = (FourBar.MECHANISM, SliderCrank.MECHANISM)": "listed",
    "SECTIONS = {shown: ((FOUR_BAR,), 'title')}": "listed",
    "for kind in (FourBar, SliderCrank): print(kind)": "listed",
    "linkage.MECHANISM == FOUR_BAR": "compared",
    "problem.mechanism[0] != 'four-bar'": "compared",
    "form.kind is not FOUR_BAR": "compared",
    "1 if mechanism in having else 2": "compared",
    "linkage.MECHANISM not in quantity.kinds": "compared",
    "linkage.MECHANISM.startswith('inverted')": "compared",
    "match linkage:\n    case FourBar(): pass": "match",
    "match linkage.MECHANISM:\n    case _: pass": "match",
    "match word:\n    case 'four-bar' | 'slider-crank': pass": "match",
    "kind_of(linkage).close(theta2)": "table",
    "[KINDS[word] for word in words]": "table",
    "if linkage.SLIDES: pass": "SLIDES",
    "@lengths.register\ndef _(linkage: FourBar) -> None: pass": "register",
    "@lengths.register(SliderCrank)\ndef _(linkage): pass": "register",
    "isinstance(one, problems.FourBar)": "isinstance",
    "import grashof.problems as values\nisinstance(one, values.FourBar)": "isinstance",
}
NOT_ASKING = (
    "FourBar((0, 0), (4, 0), 1, 3, 3).lengths",
    "made = [FourBar(*row) for row in rows] or FourBar.random()",
    "def crank(linkage: FourBar | SliderCrank, other: 'FourBar') -> dict[str, FourBar]: return {}",
    "pivots: list[FourBar] = []",
    "class Rockers(Kind[FourBar]):\n    linkage = FourBar",
    "Pairs = tuple[FourBar, SliderCrank]",
    "kind = FourBar if pinned else SliderCrank",
    "FourBar.LENGTHS",
    "type(linkage)(**linkage.stated)",
    "legend(type(linkage))",
    "isinstance(linkage, Linkage) or isinstance(task, MotionTask)",
    "type(value) is float",
    "title = 'four-bar'",
    "Names = Literal['four-bar', 'slider-crank']",
    "def near(kind: str = 'four-bar') -> None: pass",
)
PASSING = (
    "{'mechanism': linkage.MECHANISM}",
    "Problem(mechanism=linkage.MECHANISM)",
    "problem.for_kind(FOUR_BAR)",
    "f'a {linkage.MECHANISM} has no slide'",
    "f'a {FOUR_BAR} has no slide'",
    "def planted(mechanism: str = FourBar.MECHANISM) -> None: pass",
    "class Proof:\n    mechanism: str = FOUR_BAR",
    "len(problem.mechanism) == 1",
)


@pytest.fixture
def count_kinds(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "scripts")
    return import_module("count_kinds")


def ways(count_kinds: ModuleType, source: str, **others: str) -> tuple[set[str], int]:
    """How a source asks beside `others`, modules that it may import from, and how often it passes on."""
    tree = ast.parse(source)
    scopes = {f"grashof.{name}": count_kinds.Scope(ast.parse(text)) for name, text in others.items()}
    asking = count_kinds.Asking(count_kinds.Scope(tree), scopes)
    asking.visit(tree)
    return set(asking.asks), len(asking.passes)


@pytest.mark.parametrize("source", ASKING)
def test_each_way_of_asking_is_found(count_kinds: ModuleType, source: str) -> None:
    classes = "FourBar, InvertedSliderCrank, SliderCrank"
    problems = f"from grashof import problems\nfrom grashof.problems.values.linkages import {classes}"
    assert ASKING[source] in ways(count_kinds, HEAD + source, problems=problems)[0]


@pytest.mark.parametrize("source", NOT_ASKING)
def test_constructing_and_annotating_is_not_asking(count_kinds: ModuleType, source: str) -> None:
    assert ways(count_kinds, HEAD + source) == (set(), 0)


@pytest.mark.parametrize("source", PASSING)
def test_passing_the_word_on_is_told_apart(count_kinds: ModuleType, source: str) -> None:
    assert ways(count_kinds, HEAD + source) == (set(), 1)


@pytest.mark.parametrize(
    ("table", "found"),
    [
        ("KINDS = ('track', 'search')", set()),
        ("FOUR_BAR = FourBar((0, 0), (4, 0), 1, 3, 3)", set()),
        ("KINDS = ('slider-crank', 'four-bar')", {"table"}),
        ("KINDS = {kind.mechanism: kind for kind in (FourBarKind(), SliderCrankKind())}", {"table"}),
        ("from grashof.problems.values.linkages.mechanisms import KINDS", {"table"}),
    ],
)
def test_a_name_means_what_it_is_where_it_is_defined(
    count_kinds: ModuleType, table: str, found: set[str]
) -> None:
    name = "FOUR_BAR" if table.startswith("FOUR") else "KINDS"
    through = f"from grashof.tables import {name}"
    for source in (
        f"{through} as these\nthese == it",
        "from grashof import tables\n" + f"tables.{name} == it",
    ):
        assert ways(count_kinds, source, tables=table)[0] == found
    assert (
        ways(count_kinds, "from grashof.shown import it\nit == this", shown=f"{through} as it", tables=table)[
            0
        ]
        == found
    )


def test_no_kind_is_unknown_to_the_script(count_kinds: ModuleType) -> None:
    asked = import_module("kinds_asked")
    for kind in Linkage.__subclasses__():
        assert kind.__name__ in asked.CLASSES
        assert kind.__name__ == "SixBar" or kind.mechanism.word in asked.WORDS
        assert asked.HOME.match(kind.__module__)


def test_marked_bodies_of_the_closure_count_and_others_are_suspects(count_kinds: ModuleType) -> None:
    marked = "def close(x, assembly):  # closure: RRR, RPR\n    return assembly * np.sqrt(x)\n"
    bare = """
def opened(x, linkage):
    return linkage.assembly * np.sqrt(x)

def outer(x, assembly):
    def inner(y):
        return np.arccos(y)
    return inner

def of_a_number(x):
    return np.sign(x) * np.sqrt(abs(x))
"""
    text = marked + bare + "// closure: RRP\n# closure: none\n# A closure: RRR is closed\n"
    assert count_kinds.closures(text) == ["RRR", "RPR", "RRP"]
    assert count_kinds.suspects(ast.parse(marked + bare), marked + bare) == ["opened"]


@pytest.mark.slow
def test_the_figures_of_the_tree_only_fall(
    count_kinds: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = count_kinds.counted()
    figures = count_kinds.totals(found)
    for what, limits in LIMITS.items():
        assert figures[what].keys() == limits.keys()
        assert {each: count for each, count in figures[what].items() if count > limits[each]} == {}, found[
            what
        ]
    for layer, files in found["passes"].items():
        assert not files.keys() & found["asks"][layer].keys()
    monkeypatch.setattr(count_kinds, "counted", lambda: found)
    assert count_kinds.main([]) == 0
    rows = {row.split()[0]: row.split()[1:] for row in capsys.readouterr().out.splitlines()[1:6]}
    assert {layer: int(row[0]) for layer, row in rows.items()} == figures["asks"]

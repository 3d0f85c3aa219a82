"""Code that knows the kinds of linkage by name is found, and does not grow."""

import ast
from collections.abc import Callable
from types import ModuleType

import pytest

from grashof.problems import Linkage

# As counted when they were last lowered: they may only fall.
LIMITS = {
    "asks": {"problems": 1, "analysis": 1, "synth": 3, "src/grashof": 0, "scripts": 1},
    "closures": {"problems": 0, "analysis": 7, "synth": 6, "src/grashof": 6, "scripts": 2},
    "suspects": {"problems": 0, "analysis": 4, "synth": 11, "src/grashof": 0, "scripts": 1},
    "circles": {"files": 0, "rooms": 0},
    "large": {"full": 0, "long": 0},
}
ASKING = {
    "isinstance": [
        "isinstance(linkage, FourBar)",
        "not isinstance(spec.linkage, (FourBar, SliderCrank))",
        "isinstance(one, SliderCrank | InvertedSliderCrank)",
        "isinstance(one.linkage, SLIDING)",
        "issubclass(kind, problems.FourBar)",
    ],
    "compared": [
        "type(one) is FourBar",
        "type(one.linkage) is kind",
        "type(linkages[0]) in (SliderCrank, InvertedSliderCrank)",
        "type(linkage).__name__ == kind",
        "one.__class__.__name__ == 'FourBar'",
        "linkage.__class__ is kind",
        "problem.mechanism[0] != 'four-bar'",
        "form.kind is not FOUR_BAR",
        "1 if mechanism in having else 2",
        "linkage.mechanism.startswith('inverted')",
    ],
    "key": [
        "FORMULAS[type(linkage)](linkage)",
        "formulas.get(type(linkage))",
        "_FORMULAS[FourBar]",
        "FORMULAS = {FourBar: 1}",
        "FORMULAS: dict[str, int] = {FOUR_BAR: 1, **more}",
        "WORDS = {'slider-crank': 'stroke'}",
        "WORDS[problem.mechanism[0]]",
        "found[linkage.mechanism]",
        "words.setdefault(linkage.mechanism, [])",
        "{linkage.mechanism: linkage for linkage in every}",
    ],
    "listed": [
        "BOTH = (FOUR_BAR, INVERTED)",
        "SECTIONS = {shown: ((FOUR_BAR,), 'title')}",
        "for kind in (FourBar, SliderCrank): print(kind)",
    ],
    "match": [
        "match linkage:\n    case FourBar(): pass",
        "match linkage.mechanism:\n    case _: pass",
        "match word:\n    case 'four-bar' | 'slider-crank': pass",
    ],
    "table": ["kind_of(linkage).close(theta2)"],
    "register": [
        "@lengths.register\ndef _(linkage: FourBar) -> None: pass",
        "@lengths.register(SliderCrank)\ndef _(linkage): pass",
    ],
}
NOT_ASKING = (
    "from grashof.problems import FourBar, SliderCrank as Crank",
    "FourBar((0, 0), (4, 0), 1, 3, 3).lengths",
    "made = [FourBar(*row) for row in rows] or FourBar.random()",
    "def crank(linkage: FourBar | SliderCrank, other: 'FourBar') -> dict[str, FourBar]: return {}",
    "pivots: list[FourBar] = []",
    "class Rockers(Kind[FourBar]):\n    linkage = FourBar",
    "Pairs = tuple[FourBar, SliderCrank]",
    "__all__ = ['FourBar', 'SliderCrank']",
    "kind = FourBar if pinned else SliderCrank",
    "row, points = linkage.mechanism, linkage.points",
    "type(linkage)(**linkage.stated)",
    "legend(type(linkage))",
    "isinstance(linkage, Linkage) or isinstance(task, MotionTask)",
    "type(value) is float",
    "title = 'four-bar'",
    "Names = Literal['four-bar', 'slider-crank']",
    "def near(kind: str = 'four-bar') -> None: pass",
    "Problem(mechanism=linkage.mechanism)",
    "problem.for_kind(FOUR_BAR)",
    "f'a {FOUR_BAR} has no slide'",
)


@pytest.fixture(scope="module")
def count_kinds(script: Callable[[str], ModuleType]) -> ModuleType:
    return script("count_kinds")


@pytest.mark.parametrize("way", ASKING)
def test_each_way_of_asking_is_found(count_kinds: ModuleType, way: str) -> None:
    for source in ASKING[way]:
        assert way in count_kinds.asks(ast.parse(source)), source


def test_constructing_annotating_and_handing_on_is_not_asking(count_kinds: ModuleType) -> None:
    for source in NOT_ASKING:
        assert count_kinds.asks(ast.parse(source)) == {}, source


def test_no_kind_is_unknown_to_the_script(count_kinds: ModuleType) -> None:
    for kind in Linkage.__subclasses__():
        assert kind.__name__ in count_kinds.CLASSES
        assert kind.__name__ == "SixBar" or kind.mechanism.word in count_kinds.WORDS
        assert f"{kind.__module__.replace('.', '/')}/".startswith(f"grashof/{count_kinds.HOME}")


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
        above = {each: count for each, count in figures[what].items() if count > limits[each]}
        assert above == {}, found[what]
    monkeypatch.setattr(count_kinds, "counted", lambda: found)
    assert count_kinds.main() == 0
    assert f"closures, analysis: {figures['closures']['analysis']}\n" in capsys.readouterr().out

"""The kinds of linkages by their words, with the parameters that each has."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any

from grashof.problems.values.checks import each_checked, refuse
from grashof.problems.values.errors import ProblemError, listing, shown, wrong_value
from grashof.problems.values.linkages.linkage import Linkage
from grashof.problems.values.linkages.mechanism import (
    MECHANISMS,
    ONE_LOOP,
    WORDS,
    DyadKind,
    Mechanism,
    Parameter,
)
from grashof.problems.values.linkages.one_loop import FourBar, InvertedSliderCrank, SliderCrank
from grashof.problems.values.linkages.six_bar import SixBar
from grashof.problems.values.text import hint

FOUR_BAR, SLIDER_CRANK, INVERTED = ONE_LOOP
ROWS = {word: tuple(row for row in MECHANISMS if row.word == word) for word in WORDS}
SIX_BAR, SIX_BARS = (
    "six-bar",
    tuple(word for word in WORDS if word not in ONE_LOOP),
)  # the first means all others
NOISE = 1e-9  # share of a linkage's longest link that rounding leaves of a length of zero
# The parameters of all kinds, each once, in the order of tables.
PARAMETERS: tuple[Parameter, ...] = tuple(
    dict.fromkeys(row for kind in MECHANISMS for row in kind.parameters)
)
LENGTHS: tuple[str, ...] = tuple(sorted({name for kind in MECHANISMS for name in kind.lengths}))
DIMENSIONS: tuple[str, ...] = (
    *LENGTHS,
    *dict.fromkeys(
        name for kind in MECHANISMS for name in kind.dimensions if name not in (*LENGTHS, "u", "v")
    ),
    "u",
    "v",
)
ANY_KINDS = f"{listing([*WORDS, SIX_BAR])}, or a list of these"


# Their classes in Python, which describe their parameters; six-bars are `SixBar`.
CLASSES: dict[str, type[Linkage]] = dict(
    zip(ONE_LOOP, (FourBar, SliderCrank, InvertedSliderCrank), strict=True)
)


def linkage_of(word: str, given: Mapping[str, Any]) -> Linkage:
    """A linkage by the word for its kind and `Linkage.stated`; `ProblemError` if they do not make one."""
    linkage = CLASSES.get(word, SixBar)(**given)
    if (made := linkage.mechanism.word) != word:
        raise ProblemError(f"mechanism is {word}; links {linkage.choices['hosts']} carry C and D in a {made}")
    return linkage


def kinds_text(words: Sequence[str]) -> str:
    """Kinds in words: "four-bar or slider-crank"; empty for a four-bar alone, the default."""
    return "" if list(words) == [FOUR_BAR] else " or ".join(words)


def is_of(linkage: Linkage, words: Sequence[str]) -> bool:
    """Whether a linkage is of one of some kinds."""
    return linkage.mechanism.word in words


def having(column: str) -> tuple[str, ...]:
    """The kinds that have a length or parameter, by its name or its column in tables."""
    return tuple(word for word in ROWS if column in _names(word))


@cache
def _names(word: str) -> frozenset[str]:
    """Lengths and parameters of a kind, and their columns."""
    kinds = ROWS[word]
    rows = [row for kind in kinds for row in kind.parameters]
    names = [name for row in rows for name in (row.name, row.key, *row.columns)]
    return frozenset([*names, *(name for kind in kinds for name in kind.dimensions)])


def closing_dyad(kind: str) -> DyadKind:
    """The dyad of links 3 and 4."""
    return ROWS[kind][0].dyads[0].kind


def has_one_loop(word: str) -> bool:
    """Whether linkages of a kind have a single loop."""
    return len(ROWS[word][0].loops) == 1


def freedoms(kinds: Iterable[Mechanism]) -> int:
    """The least number of dimensions of linkages of some kinds, without the angle of the guided body."""
    every = (
        [row for row in one.parameters if row.kind != "sign" and row.name != "body_angle"] for one in kinds
    )
    return min(sum(1 + row.paired for row in rows) for rows in every)


def lengths_text(linkage: Linkage, digits: int = 4) -> str:
    """The lengths of a single linkage, and the offset of its slide: "r1 to r4 4, 1, 4, 3"."""
    if linkage.mechanism.word == FOUR_BAR:
        return f"r1 to r4 {', '.join(f'{length:.{digits}g}' for length in linkage.lengths)}"
    sizes = {name: without_noise(float(getattr(linkage, name)), linkage) for name in linkage.mechanism.sizes}
    return ", ".join(f"{name} {value:.{digits}g}" for name, value in sizes.items())


def without_noise(length: float, linkage: Linkage) -> float:
    """A length of a single linkage for display: 0 where it is rounding noise.

    Examples
    --------
    >>> rod = SliderCrank((0, 0), 1, 4, offset=-3e-12)
    >>> without_noise(float(rod.offset), rod), without_noise(0.1, rod)
    (0.0, 0.1)
    """
    return 0.0 if abs(length) < NOISE * float(linkage.lengths.max()) else length


def not_had(what: str, given: Sequence[str], kinds: Sequence[str]) -> str:
    """The error of a key or quantity that only other kinds of linkages have."""
    ending = "has it" if len(kinds) == 1 else "have it"
    return f"{what} does not go with mechanism {joined(given)}; only {joined(kinds)} {ending}"


def joined(words: Sequence[str]) -> str:
    """Words in a list: "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), *words[-1:])))


def mechanisms(given: str | Sequence[str]) -> tuple[str, ...]:
    """Words for kinds of linkages, one or several; `ProblemError` for no such kind, none, or one twice."""
    if isinstance(given, str):
        return (mechanism(given),)
    if not isinstance(given, Sequence) or not len(given):
        raise wrong_value("mechanism", given, ANY_KINDS)
    each_checked(given, "mechanism", mechanism)
    refuse([f"mechanism has {word} {count} times" for word, count in Counter(given).items() if count > 1])
    return tuple(given)


def spelt_out(words: Sequence[str], impossible: Callable[[str], str]) -> tuple[str, ...]:
    """The kinds for words of a problem: "six-bar" stands for all six-bars that are not impossible, if any."""
    able = [word for word in SIX_BARS if not impossible(word)] or SIX_BARS
    return tuple(dict.fromkeys(kind for word in words for kind in (able if word == SIX_BAR else (word,))))


def mechanism(word: str, where: str = "mechanism", among: Sequence[str] = (*WORDS, SIX_BAR)) -> str:
    """A word for a kind of linkages, checked: one of those of problems, or of others."""
    if isinstance(word, str) and word in among:
        return word
    known = hint(word, among, f"it must be {listing(among)}")
    raise ProblemError(f"{where} is {shown(word)}; {known}")

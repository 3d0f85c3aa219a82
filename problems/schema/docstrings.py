"""Descriptions of parameters in numpydoc docstrings, and texts in Markdown."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass
from itertools import pairwise

_NAME = re.compile(r"``(.+?)``|(?<![`\w])`([^`]+)`(?!`)")
_SYMBOL = re.compile(r"\w\d|omega|theta|mu\b")  # stays as it is at the beginning of a sentence
_ENTRY = re.compile(r"^(?P<names>\*{0,2}\w+(?:, (?:\w+|\.\.\.))*) : (?P<type>.+)$")


@dataclass(frozen=True, slots=True)
class Described:
    """A parameter as its docstring has it: what stands after the colon, and the lines below as one text."""

    type: str
    text: str


def parameters_of(documented: object) -> dict[str, Described]:
    """Parameters of a class or function by name, those of a line shared by several names for each of them.

    Examples
    --------
    >>> class Bar:
    ...     '''A bar.
    ...
    ...     Parameters
    ...     ----------
    ...     width, height : float, length
    ...         Of its section.
    ...     '''
    >>> parameters_of(Bar)["height"]
    Described(type='float, length', text='Of its section.')
    """
    lines = _section(inspect.cleandoc(documented.__doc__ or "").splitlines(), "Parameters")
    found: dict[str, Described] = {}
    examples: set[str] = set()  # "size, worst_move, ..." describes a group, not its members
    names: list[str] = []
    for line in lines:
        if entry := _ENTRY.match(line):
            names = [name.lstrip("*") for name in entry["names"].split(", ")]
            found |= dict.fromkeys(names, Described(entry["type"], ""))
        elif line.strip():
            known = found[names[0]]
            found |= dict.fromkeys(names, Described(known.type, f"{known.text} {line.strip()}".strip()))
            examples |= {*names} if "..." in names else set()
    return {name: each for name, each in found.items() if name not in examples}


def summary_of(documented: object) -> str:
    """The first line of a docstring."""
    return inspect.cleandoc(documented.__doc__ or "").partition("\n")[0]


def _section(lines: list[str], title: str) -> list[str]:
    """The lines of a section of a docstring, without its heading."""
    heads = [i for i in range(len(lines) - 1) if lines[i + 1] and not lines[i + 1].strip("-")]
    for start, end in pairwise([*heads, len(lines)]):
        if lines[start] == title:
            return lines[start + 2 : end]
    return []


def code(text: str) -> str:
    """Text set as code."""
    return f"`{text}`" if text else ""


def sentence(text: str) -> str:
    """A text of a docstring as a sentence in Markdown: the first letter large, a full stop at its end.

    Examples
    --------
    >>> sentence("least of ``|x|``, see `Problem`")
    'Least of `|x|`, see `Problem`.'
    >>> sentence("r1, ground link")
    'r1, ground link.'
    """
    plain = _NAME.sub(lambda found: code(found[1] or found[2]), text.strip())
    if not _SYMBOL.match(plain):
        plain = plain[:1].upper() + plain[1:]
    return plain if not plain or plain.endswith(".") else f"{plain}."

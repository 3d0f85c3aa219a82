"""Pieces of Markdown."""

from __future__ import annotations

import re

_NAME = re.compile(r"``(.+?)``|(?<![`\w])`([^`]+)`(?!`)")
_SYMBOL = re.compile(r"\w\d|omega|theta|mu\b")  # stays as it is at the beginning of a sentence


def code(text: str) -> str:
    """Text set as code."""
    return f"`{text}`" if text else ""


def row(*cells: str) -> str:
    """A row of a table."""
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


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

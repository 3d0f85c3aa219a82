"""Words for messages, and text that files and terminals can hold."""

from __future__ import annotations

import difflib
import re
import unicodedata
from collections.abc import Sequence

from grashof.problems.values.errors import ProblemError, shown

# Begins a formula in a spreadsheet, also in wide East Asian forms, perhaps after blanks.
_FORMULA = re.compile(r"(^|;)(?=\s*[=+\-@＝＋－＠]|[\t\r\n])")


def counted(number: int, noun: str) -> str:
    """Count with its noun: 1 corner, 2 corners, 2 families."""
    if number == 1:
        return f"{number} {noun}"
    return f"{number} {noun[:-1]}ies" if noun.endswith(("ly", "ry")) else f"{number} {noun}s"


def with_article(noun: str) -> str:
    """A noun with its article: a slider-crank, an engine."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


def near_miss(word: str, words: Sequence[str]) -> str | None:
    """The entry of `words` that `word` may misspell, if any."""
    by_folded = {name.casefold(): name for name in words}
    close = difflib.get_close_matches(word.casefold(), by_folded, n=1)
    return by_folded[close[0]] if close else None


def hint(word: object, words: Sequence[str], otherwise: str) -> str:
    """The end of a message about an unknown word: a likely spelling, or else the given text."""
    meant = near_miss(word, words) if isinstance(word, str) else None
    return f"did you mean {meant}?" if meant else otherwise


def readable(text: str) -> str:
    """Text that every file and terminal can hold, such as of a file name that is not UTF-8."""
    return "".join("?" if _unprintable(character) else character for character in text)


def file_name(text: str) -> str:
    """A name for files, of letters, digits, dots and dashes.

    >>> file_name("../my task"), file_name("")
    ('my-task', 'task')
    """
    return re.sub(r"[^\w.-]+", "-", readable(text)).strip("-._")[:60] or "task"


def no_formula(text: str) -> str:
    r"""Text that no spreadsheet runs as a formula: a quotation mark before text that begins like one.

    Also behind a semicolon, at which many spreadsheets divide the lines of a CSV file.

    Examples
    --------
    >>> no_formula("=1+1"), no_formula("\t@SUM(A1)"), no_formula("m; -1"), no_formula("1-2")
    ("'=1+1", "'\t@SUM(A1)", "m;' -1", '1-2')
    """
    return _FORMULA.sub(r"\1'", text)


def plain_text(text: str, where: str) -> str:
    """`text`, refused where a terminal, SVG or HTML would stumble over it: control characters, half ones."""
    if not isinstance(text, str):
        raise ProblemError(f"{where} is {shown(text)}; it must be text")
    for character in filter(_unprintable, text):
        raise ProblemError(f"{where} has control character U+{ord(character):04X}; it must be plain text")
    return text


def _unprintable(character: str) -> bool:
    # Control characters, halves of surrogate pairs, and the two that XML does not know.
    return unicodedata.category(character) in ("Cc", "Cs") or character in "\ufffe\uffff"

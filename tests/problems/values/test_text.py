"""Words for messages, and text that files and terminals can hold."""

import pytest

from grashof.problems import ProblemError
from grashof.problems.values.text import near_miss, plain_text, readable


@pytest.mark.parametrize(
    ("word", "expected"),
    [("lugage", "luggage"), ("LUGGAGE", "luggage"), ("R1", "r1"), ("wheelbarrow", None), ("", None)],
)
def test_near_miss(word: str, expected: str | None) -> None:
    assert near_miss(word, ["luggage", "r1"]) == expected


@pytest.mark.parametrize("character", ["\x00", "\x9b", "\ud800", "\uffff"])
def test_control_characters_are_refused_or_replaced(character: str) -> None:
    with pytest.raises(
        ProblemError, match=rf"^title has control character U\+{ord(character):04X}; it must be"
    ):
        plain_text(f"a{character}b", "title")
    assert readable(f"a{character}b") == "a?b"


def test_text_of_all_languages_is_plain() -> None:
    for text in ("", "Étage \u2082", '階段 <&> "$x$"', "\U0001f9f3"):
        assert plain_text(text, "title") == readable(text) == text

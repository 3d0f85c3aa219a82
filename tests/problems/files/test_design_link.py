"""Links of designs: read back to the last bit after any mail program; damaged ones refused in a line."""

from __future__ import annotations

import base64
import json
import textwrap
import zlib
from collections.abc import Iterator
from typing import Any
from urllib.parse import quote

import numpy as np
import pytest

from grashof import load
from grashof.problems import FourBar, LinkageSpec, ProblemError, load_linkage_spec, problem_text
from grashof.problems.files.design_link import SharedDesign, design_link, is_link, read_link
from grashof.problems.files.linkage_writing import linkage_toml
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_writing import problem_toml

PAGE = "http://127.0.0.1:8000/"
DOCUMENT = document_of(problem_text("luggage"), "luggage.toml")
NUMBERS = [1 / 3, 5e-324, 1.7e308, 0.1 + 0.2, -0.0, *np.random.default_rng(5).normal(size=40)]


def link_of(linkage: FourBar, document: dict[str, Any] = DOCUMENT) -> str:
    text = linkage_toml(LinkageSpec(linkage, "design", title="ü: 3", length_unit="m"))
    return design_link(SharedDesign("luggage", document, text), PAGE)


ROCKER = FourBar((-0.0, 1 / 3), (4, 0.1 + 0.2), 1.5, 4.1, 3 + 1e-15, (1 / 7, -2), -1, body_angle=0.3)
LINK = link_of(ROCKER)
START = LINK.index("=") + 1
DAMAGED = "the link is damaged or cut off; copy all of it, to its last character"


def packed(content: object) -> str:
    text = content if isinstance(content, bytes) else json.dumps(content).encode()
    return f"{PAGE}#design={base64.urlsafe_b64encode(zlib.compress(text)).decode()}"


def test_problem_and_linkage_come_back_to_the_last_bit() -> None:
    document = {**DOCUMENT, "scene": {"outlines": [[[x, -x] for x in NUMBERS]]}}
    read = read_link(link_of(ROCKER, document))
    assert json.dumps(read.document) == json.dumps(document)  # also the sign of zero
    spec = load_linkage_spec(LINK)
    assert repr(spec.linkage.stated) == repr(ROCKER.stated)
    assert (spec.title, spec.name) == ("ü: 3", "luggage")
    assert spec.problem is not None
    assert problem_toml(spec.problem) == problem_toml(load("luggage"))
    assert read_link(design_link(SharedDesign("a", {}), PAGE)) == SharedDesign("a", {}, "")


@pytest.mark.parametrize(
    "mailed",
    ["\r\n".join(textwrap.wrap(LINK, 76)), f"<{LINK}>", LINK[LINK.index("#") :], quote(LINK), f" {LINK}.\n"],
    ids=["in lines", "in brackets", "fragment", "quoted", "in a sentence"],
)
def test_mails_do_not_harm_it(mailed: str) -> None:
    assert is_link(mailed)
    assert read_link(mailed) == read_link(LINK)


def damaged() -> Iterator[str]:
    """The link without each of its characters, with another in its place, and cut off."""
    for k in range(START, len(LINK)):
        yield LINK[:k] + LINK[k + 1 :]
        yield LINK[:k] + ("A" if LINK[k] != "A" else "B") + LINK[k + 1 :]
        yield LINK[:k]


def test_damage_is_never_another_design() -> None:
    expected, refusals = read_link(LINK), []
    for link in damaged():
        try:
            assert read_link(link) == expected  # a bit that only fills the last character
        except ProblemError as error:
            refusals.append(str(error))
    assert set(refusals) == {DAMAGED}
    assert len(refusals) >= 3 * (len(LINK) - START) - 2


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ("http://127.0.0.1/#token", "has no design of grashof live in its fragment"),
        (f"{PAGE}#design=%%%", "damaged"),
        (packed([1]), "has no design"),
        (packed(b"[" * 100_000), "has no design"),
        (packed(b"\xff"), "has no design"),
        (packed({"name": "x", "problem": {}}), "has no design"),
        (packed({"name": "x", "problem": 3, "linkage": ""}), "has no design"),
        (packed(b" " * 2_000_000), "more than 1000000 bytes"),
    ],
)
def test_foreign_links_are_refused_in_a_line(given: str, line: str) -> None:
    with pytest.raises(ProblemError, match=line) as refusal:
        read_link(given)
    assert len(str(refusal.value).splitlines()) == 1


def test_what_a_link_states_is_checked_as_its_files_are() -> None:
    assert read_link(packed({"name": "../../x", "problem": {}, "linkage": ""})).name == "x"
    cases = {
        "a problem alone": SharedDesign("x", DOCUMENT),
        "r2": SharedDesign("x", DOCUMENT, "r2 = -1"),
        "is not TOML": SharedDesign("x", DOCUMENT, "r2 ="),
        "kind": SharedDesign("x", {}, linkage_toml(LinkageSpec(ROCKER, "x"))),
    }
    for line, shared in cases.items():
        with pytest.raises(ProblemError, match=line) as refusal:
            load_linkage_spec(design_link(shared, PAGE))
        assert all(each.startswith("the link") for each in str(refusal.value).splitlines())
    files = {**DOCUMENT, "motion": {"poses": "/etc/passwd.csv"}}
    with pytest.raises(ProblemError, match="poses"):
        load_linkage_spec(link_of(ROCKER, files))


@pytest.mark.parametrize("given", ["luggage", "designs/candidates.json#3", "a#b", "leg.svg#foot", ""])
def test_other_names_are_no_links(given: str) -> None:
    assert not is_link(given)

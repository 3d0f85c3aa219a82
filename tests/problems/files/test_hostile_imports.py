"""Drawings and tables that expand, contain themselves or are damaged: refused in a line, soon."""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile

import ezdxf
import openpyxl
import pytest
from refusals import refusal

from grashof import load
from grashof.problems import ProblemError
from grashof.problems.files import on_disk
from grashof.problems.files.dxf_lines import Budget, dxf_drawing
from grashof.problems.files.named_files import curve_points_of, outlines_of
from grashof.problems.files.spreadsheet import rows_of

SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink">{}</svg>'
LINE = '<path d="M 0 0 L 3 4"/>'


def refused(folder: Path, name: str, content: bytes | str) -> str:
    """The one line with which a file is refused."""
    (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    read = rows_of if name.endswith(("xlsx", "csv")) else lambda *at: outlines_of(*at, "")
    line = refusal(read, name, folder)
    assert "\n" not in line
    assert name in line
    assert len(line) < 400
    return line.rpartition(f"{name}: ")[2]


@pytest.fixture
def work(monkeypatch: pytest.MonkeyPatch) -> Callable[[], int]:
    """How many parts were counted until a file was refused: the work that it made."""
    spent = [0]
    spend = Budget.spend

    def counting(budget: Budget, count: int = 1) -> None:
        spent[0] += 1
        spend(budget, count)

    monkeypatch.setattr(Budget, "spend", counting)
    return lambda: spent[0]


def uses(levels: int) -> str:
    """Groups of ten uses of one another."""
    groups = [f'<g id="g{k}">{f"<use href={chr(34)}#g{k - 1}{chr(34)}/>" * 10}</g>' for k in range(1, levels)]
    return SVG.format(f'<g id="g0">{LINE}</g>{"".join(groups)}')


def test_svg_that_uses_itself_or_expands(tmp_path: Path, work: Callable[[], int]) -> None:
    assert outlines_of_text(tmp_path, uses(3))  # ten times ten lines are read
    assert refused(tmp_path, "a.svg", uses(12)) == "the drawing has more than 40000 places; that is the most"
    itself = SVG.format(f'<g id="g">{LINE}<use xlink:href="#g"/></g>')
    assert "nested more than 32 deep" in refused(tmp_path, "a.svg", itself)
    assert "nested more than 32 deep" in refused(
        tmp_path, "a.svg", SVG.format("<g>" * 5000 + LINE + "</g>" * 5000)
    )
    assert work() < 100_000


def outlines_of_text(folder: Path, text: str) -> list[list[list[float]]]:
    (folder / "right.svg").write_text(text)
    return outlines_of("right.svg", folder, "")


def test_curves_that_expand_or_are_wrong(tmp_path: Path, work: Callable[[], int]) -> None:
    def points(name: str, content: str | bytes) -> str:
        (tmp_path / name).write_bytes(content.encode() if isinstance(content, str) else content)
        return refusal(curve_points_of, name, tmp_path, "mm", 40)

    assert "the drawing has more than 40000 places" in points("a.svg", uses(12))
    assert "the drawing has 111 paths; give one an id" in points("a.svg", uses(3))
    lines = dxf(lambda document: [document.modelspace().add_circle((0, 0), 1) for _ in range(3)])
    assert "more than two ends meet at (1, 0)" in points("a.dxf", lines)
    spline = dxf(lambda document: document.modelspace().add_spline(dxfattribs={"degree": 3}))
    for empty in (spline, dxf(lambda _: None)):
        assert points("a.dxf", empty) == "a.dxf: the drawing has no lines in its model space"
    many = dxf(lambda document: document.modelspace().add_lwpolyline([(k, k % 2) for k in range(20_002)]))
    assert points("a.dxf", many) == "a.dxf: the drawing has more than 20000 pieces; that is the most"
    assert work() < 100_000


@pytest.mark.parametrize(
    "drawn",
    [
        '<path d="T 1 1"/>',
        '<path d="M 1e999 0 L 1 1"/>',
        '<g transform="rotate(1e400)"><path d="M 0 0 L 1 1"/></g>',
        '<rect width="x" height="1"/>',
        '<path d="A 1"/>',
        "<path",
        "&bomb;",
        "",
    ],
)
def test_svg_that_is_wrong(tmp_path: Path, drawn: str) -> None:
    refused(tmp_path, "a.svg", SVG.format(drawn))


def test_hidden_lines_of_svg_are_left_out(tmp_path: Path) -> None:
    style = "<style>.off, .dim { fill: red; display: none } .on { stroke: blue }</style>"
    hidden = (
        f'<g class="off">{LINE}</g><g style="stroke:red;display:none">{LINE}</g><g display="none">{LINE}</g>'
    )
    drawing = SVG.format(f'{style}{hidden}<path class="on" d="M 1 1 L 7 4"/>')
    assert outlines_of_text(tmp_path, drawing) == [[[1.0, -1.0], [7.0, -4.0]]]


def dxf(change: Callable[[ezdxf.document.Drawing], object]) -> bytes:
    document = ezdxf.new()
    change(document)
    stream = StringIO()
    document.write(stream)
    return stream.getvalue().encode()


@pytest.mark.study
def test_dxf_blocks_that_expand(tmp_path: Path, work: Callable[[], int]) -> None:
    def array(document: ezdxf.document.Drawing) -> None:
        document.blocks.new("B").add_line((0, 0), (1, 1))
        insert = document.modelspace().add_blockref("B", (0, 0))
        insert.dxf.row_count = insert.dxf.column_count = 30_000
        insert.dxf.row_spacing = insert.dxf.column_spacing = 1

    def doubling(document: ezdxf.document.Drawing) -> None:
        document.blocks.new("B0").add_line((0, 0), (1, 1))
        for level in range(1, 30):
            block = document.blocks.new(f"B{level}")
            block.add_blockref(f"B{level - 1}", (0, 0))
            block.add_blockref(f"B{level - 1}", (1, 0))
        document.modelspace().add_blockref("B29", (0, 0))

    def itself(document: ezdxf.document.Drawing) -> None:
        block = document.blocks.new("B")
        block.add_line((0, 0), (1, 1))
        block.add_blockref("B", (1, 0))
        document.modelspace().add_blockref("B", (0, 0))

    def twice(document: ezdxf.document.Drawing) -> None:
        document.blocks.new("B").add_line((0, 0), (1, 1))
        insert = document.modelspace().add_blockref("B", (5, 0))
        insert.dxf.row_count, insert.dxf.row_spacing = 2, 10

    too_many = "the drawing has more than 20000 entities; that is the most"
    assert refused(tmp_path, "a.dxf", dxf(array)) == too_many
    assert refused(tmp_path, "a.dxf", dxf(doubling)) == too_many
    assert (
        refused(tmp_path, "a.dxf", dxf(itself))
        == "blocks are nested more than 32 deep, perhaps in themselves"
    )
    assert work() < 50_000
    lines, _ = dxf_drawing(dxf(twice))
    assert [line.tolist() for line in lines] == [[[5, 0], [6, 1]], [[5, 10], [6, 11]]]


@pytest.mark.parametrize(
    "change",
    [
        lambda space: space.add_circle((0, 0), 1e300),
        lambda space: space.add_line((0, float("nan")), (1, 1)),
        lambda space: space.add_lwpolyline([(0, 0), (1, 0, 0, 0, float("inf")), (2, 1)]),
        lambda space: space.add_ellipse((0, 0), (1, 0), 0.5, 0, 1e300),
    ],
    ids=["circle", "line", "bulge", "ellipse"],
)
def test_dxf_numbers_are_checked_before_curves_are_divided(
    tmp_path: Path, change: Callable[[Any], object]
) -> None:
    refused(tmp_path, "a.dxf", dxf(lambda document: change(document.modelspace())))


def workbook(change: Callable[[openpyxl.worksheet.worksheet.Worksheet], object]) -> bytes:
    book, stream = openpyxl.Workbook(), BytesIO()
    change(book.active)
    book.save(stream)
    return stream.getvalue()


def test_workbooks_with_a_cell_far_away(tmp_path: Path) -> None:
    far = workbook(lambda sheet: sheet.cell(1_048_576, 1, 5))
    assert refused(tmp_path, "a.xlsx", far) == "has more than 20000 rows; it must have at most that"
    wide = workbook(lambda sheet: sheet.cell(1, 16_384, 5))
    (tmp_path / "wide.xlsx").write_bytes(wide)
    assert rows_of("wide.xlsx", tmp_path) == []  # nothing but that cell, beyond any table


def test_a_workbook_that_unpacks_to_more_than_it_should(tmp_path: Path) -> None:
    stream = BytesIO(workbook(lambda sheet: sheet.append(["x", "y"])))
    with ZipFile(stream, "a", ZIP_DEFLATED) as parts:
        parts.writestr("xl/filling.xml", b" " * (on_disk.MOST_BYTES + 1))
    assert "bytes when it is unpacked" in refused(tmp_path, "a.xlsx", stream.getvalue())


@pytest.mark.slow
def test_damaged_workbooks_and_drawings_are_refused_or_read(tmp_path: Path) -> None:
    """Each with its own bytes changed, its parts shortened, exchanged or lost: never another error."""
    rng = random.Random(5)  # noqa: S311
    book = workbook(lambda sheet: [sheet.append(row) for row in (["x", "y"], [1, 2.5], ["a", True])])
    circle = dxf(lambda document: document.modelspace().add_circle((0, 0), 1))
    lines = SVG.format(
        '<g transform="rotate(3)"><path d="M 0 0 C 1 1 2 1 3 0 A 5 5 0 0 1 9 9 z"/></g>'
    ).encode()
    said: list[str] = []
    for _ in range(60):
        for name, content in (("a.xlsx", book), ("a.dxf", circle), ("a.svg", lines)):
            damaged = _repacked(content, rng) if name == "a.xlsx" else _damaged(content, rng)
            (tmp_path / name).write_bytes(damaged)
            try:
                rows_of(name, tmp_path) if name == "a.xlsx" else outlines_of(name, tmp_path, "")
            except ProblemError as error:
                said.append(str(error))
    assert len(said) > 60
    assert all(line.isprintable() for line in said)  # one line each


def _damaged(content: bytes, rng: random.Random) -> bytes:
    changed = bytearray(content)
    for _ in range(rng.randint(1, 4)):
        at = rng.randrange(len(changed))
        kind = rng.randrange(3)
        if kind == 0:
            changed[at] = rng.randrange(256)
        elif kind == 1:
            changed[at:at] = changed[at : at + rng.randint(1, 40)] * rng.randint(1, 3)
        else:
            del changed[at : at + rng.randint(1, 40)]
        changed = changed or bytearray(b"x")
    return bytes(changed)


def _repacked(content: bytes, rng: random.Random) -> bytes:
    stream = BytesIO()
    with ZipFile(BytesIO(content)) as old, ZipFile(stream, "w") as new:
        harmed = rng.choice(old.namelist())
        for name in old.namelist():
            if name != harmed:
                new.writestr(name, old.read(name))
            elif rng.random() < 0.8:
                new.writestr(name, _damaged(old.read(name), rng))
    return stream.getvalue()


def test_tables_of_text(tmp_path: Path) -> None:
    assert "field larger than field limit" in refused(tmp_path, "a.csv", f"x,y\n1,{'2' * 200_000}\n")
    assert refused(tmp_path, "a.csv", "\n" * 30_000) == "has more than 20000 lines; it must have at most that"
    assert on_disk.MOST_BYTES < 10**7
    assert "bytes; a CSV file must have at most that" in refused(tmp_path, "a.csv", "1,2\n" * 2_000_000)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes")
def test_pipes_and_devices_are_not_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "a.csv")
    with pytest.raises(ProblemError, match=r"a\.csv: is not a plain file; it must be a CSV file"):
        rows_of("a.csv", tmp_path)
    os.mkfifo(tmp_path / "task.toml")
    with pytest.raises(ProblemError, match=r"task\.toml: is not a plain file"):
        load(tmp_path / "task.toml")
    if Path("/dev/zero").exists():
        (tmp_path / "a.svg").symlink_to("/dev/zero")
        with pytest.raises(ProblemError, match="is not a plain file; it must be a drawing"):
            outlines_of("a.svg", tmp_path, "")


def test_lists_are_as_long_as_tables_at_most(tmp_path: Path) -> None:
    path = tmp_path / "long.toml"
    path.write_text(f'kind = "path"\n[path]\npoints = {[[0, 0]] * 10_001}\n')
    with pytest.raises(ProblemError, match="it must be a list of at most 10000 entries"):
        load(path)

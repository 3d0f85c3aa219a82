"""Parameters read back give the linkage."""

import csv
import re
from io import StringIO

import numpy as np
import pytest

from grashof.models import Model, freecad, solidworks
from grashof.models.parameters import rows
from grashof.problems import FourBar, LinkageSpec, ProblemError

ROW = re.compile(r'"(\w+)" = (-?\d[\d.e+-]*?)(mm|cm|m|in|ft|deg|)')


def expected(model: Model) -> dict[str, float]:
    linkage, at = model.linkage, model.first
    left_out = ("assembly", "assembly_2", "hosts", "point_link", "body_angle_deg")
    kept = {name: float(value) for name, value in linkage.columns.items() if name not in left_out}
    angles = {2: model.start} | {link.number: at.angles[link.number] for link in linkage.mechanism.links[2:]}
    return kept | {f"theta{link}_deg": float(np.degrees(angle)) for link, angle in angles.items()}


def test_an_open_linkage_has_no_model() -> None:
    with pytest.raises(ProblemError, match="apart cannot be assembled at any driver angle"):
        Model.of(LinkageSpec(FourBar((0, 0), (100, 0), 5, 9, 8), "apart"))


def test_solidworks_equations(model: Model) -> None:
    lines = solidworks(model).splitlines()
    matches = [ROW.fullmatch(line) for line in lines]
    assert None not in matches
    found = {match[1]: float(match[2]) for match in matches if match}
    assert found == pytest.approx(expected(model), rel=1e-14)
    for match in matches:
        assert match is not None
        assert match[3] == ("deg" if match[1].endswith("_deg") else model.spec.length_unit)


def test_a_freecad_table(model: Model) -> None:
    read = list(csv.reader(StringIO(freecad(model)), delimiter="\t"))
    assert [row[0] for row in read] == [row.name for row in rows(model)]
    found = {name: float(content.removeprefix("=").split()[0]) for name, content in read}
    assert found == pytest.approx(expected(model), rel=1e-14)
    for name, content in read:
        unit = "deg" if name.endswith("_deg") else model.spec.length_unit
        assert content.removeprefix("=").split()[1:] == ([unit] if unit else [])

"""`grashof show`: a design as text, and that text read back to the last digit."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command_runs import Grashof

from grashof.output.run_files import write_run
from grashof.problems import (
    Cylinder,
    FourBar,
    LinkageSpec,
    SixBar,
    SliderCrank,
    linkage_catalogue,
    problem_text,
)
from grashof.problems.files.design_link import SharedDesign, design_link
from grashof.problems.files.linkage_file import load_linkage_spec
from grashof.problems.files.linkage_writing import linkage_toml
from grashof.problems.files.on_disk import document_of
from grashof.problems.values.dynamics.dynamics_spec import DynamicsSpec
from grashof.synth import Result

ANGLES = np.random.default_rng(3).uniform(-7, 7, 60).tolist()


@pytest.fixture
def folder(few: Result, tmp_path: Path) -> Path:
    write_run(tmp_path / "found", few, {}, 0)
    return tmp_path / "found"


def read_back(spec: LinkageSpec, folder: Path) -> LinkageSpec:
    path = folder / f"{spec.name}.toml"
    path.write_text(linkage_toml(spec), encoding="utf-8")
    found = load_linkage_spec(path)
    assert found.linkage.stated == spec.linkage.stated  # floats, to the last bit
    assert type(found.linkage) is type(spec.linkage)
    return found


def test_a_design_by_folder_list_rank_and_id(grashof: Grashof, few: Result, folder: Path) -> None:
    one = few.candidates[2]
    said = grashof("show", folder, "3").stdout
    for given in ((folder, one.id), (folder / "candidates.json", "3"), (f"{folder}/candidates.json#3",)):
        done = grashof("show", *given)
        assert (done.exit_code, done.stdout, done.stderr) == (0, said, "")
    assert grashof("show", folder).stdout == grashof("show", folder, 1).stdout != said
    assert len(said.splitlines()) < 25
    assert str(folder) not in said
    (folder / "third.toml").write_text(said, encoding="utf-8")
    read, listed = (
        load_linkage_spec(each) for each in (folder / "third.toml", f"{folder}/candidates.json#3")
    )
    assert read == replace(listed, name="third", source="")
    assert read.linkage.stated == one.linkage.stated
    judged = [
        grashof("judge", name, "luggage") for name in (folder / "third.toml", f"{folder}/candidates.json#3")
    ]
    assert [each.exit_code for each in judged] == [0, 0]
    assert judged[0].stdout.splitlines()[1:] == judged[1].stdout.splitlines()[1:]


def test_a_link_is_read_wherever_a_linkage_is(
    grashof: Grashof, refused: Callable[..., str], folder: Path
) -> None:
    said = grashof("show", folder, "2").stdout
    document = document_of(problem_text("luggage"), "luggage.toml")
    link = design_link(SharedDesign("luggage", document, said), "http://127.0.0.1/")
    assert grashof("show", link).stdout == said
    judged = [grashof("judge", name, "luggage").stdout for name in (link, f"{folder}/candidates.json#2")]
    assert judged[0].splitlines()[1:] == judged[1].splitlines()[1:]
    assert "NUMBER is 2; a link has one design" in refused("show", link, 2)
    assert "the link is damaged" in refused("analyse", link[:-9])


def test_a_list_may_have_another_name(grashof: Grashof, folder: Path) -> None:
    (folder / "document.json").write_text((folder / "candidates.json").read_text())
    assert grashof("show", folder / "document.json", 2).stdout == grashof("show", folder, 2).stdout


@pytest.mark.parametrize("name", linkage_catalogue())
def test_linkages_of_the_catalogue_come_back(name: str, tmp_path: Path) -> None:
    spec = load_linkage_spec(name)
    assert read_back(spec, tmp_path) == spec


def test_any_angle_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    """Degrees alone give eleven in twelve."""
    in_radians = 0
    for angle in ANGLES:
        linkage = SliderCrank(o2=(0.1, -0.7), r2=1 / 3, r3=2.7, offset=-0.1, slide_angle=angle,
                              coupler_point=(1, 0.3), body_angle=-angle / 3)  # fmt: skip
        read_back(LinkageSpec(linkage, "crank", length_unit="mm"), tmp_path)
        written = tomllib.loads((tmp_path / "crank.toml").read_text())
        assert ("slide_angle" in written) != ("slide_angle_deg" in written)
        in_radians += "slide_angle" in written
    assert 0 < in_radians < len(ANGLES) / 3


def test_a_press_comes_back(tmp_path: Path) -> None:
    loop = {"o2": (0, 0), "o4": (4, 0), "r2": 1, "r3": 4, "r4": 3, "assembly": -1}
    for angle in ANGLES[:9]:
        press = SixBar(**loop, coupler_point=(0.1, 0.2), hosts=(4, 1), point_link=6, c=(4, 1), r5=7,
                       offset_2=-2, slide_angle_2=angle, assembly_2=1)  # fmt: skip
        assert read_back(LinkageSpec(press, "press"), tmp_path).linkage.mechanism == press.mechanism


def test_cylinder_masses_loads_and_the_sense_of_rotation_come_back(tmp_path: Path) -> None:
    bar = FourBar((0, 0), (4, 0.1), 1, 4, 3, coupler_point=(2, 1 / 3), body_angle=0.1)
    dynamics = DynamicsSpec(
        masses=(1, 0.1, 2), inertias=(0.3, 0.2, 0.1), gravity=(0, -9.81), speed_rpm=-1 / 3
    )
    driven = Cylinder("coupler", base=(0.1, -2), point=(1.5, 1 / 7))
    spec = LinkageSpec(bar, "lift", length_unit="m", output_arm=0.7, dynamics=dynamics, cylinder=driven)
    assert read_back(spec, tmp_path) == spec


def test_what_cannot_be_shown(refused: Callable[..., str], folder: Path) -> None:
    assert "has no design 99; name a rank, 1 to" in refused("show", folder, 99)
    assert "NUMBER is 2; pumpjack is one linkage" in refused("show", "pumpjack", 2)
    assert "is neither a linkage of the catalogue nor a file" in refused("show", "nothing")
    (folder / "candidates.json").write_text(json.dumps({"designs": []}))
    assert "is not a list of designs" in refused("show", folder)

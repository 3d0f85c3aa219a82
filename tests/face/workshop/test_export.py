"""`grashof export`: files, refusals in one line, exit codes; the order of the layers."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from command_runs import Grashof, assert_one_line
from typer.main import get_command

from grashof.cli import app
from grashof.output.run_files import write_run
from grashof.problems import FourBar, ProblemError
from grashof.synth import Result
from grashof.workshop import Plan, plan_parts
from grashof.workshop.export import FORMATS, WORKBOOK

PLAIN = "o4 = [100, 0]\nr2 = 30\nr3 = 90\nr4 = 80\n"
DRAG = FourBar((0, 0), (60, 0), 100, 110, 90)


def layers(plan: Plan) -> dict[str, tuple[int, ...]]:
    return {part.plate.name: part.layers for part in plan.parts}


def test_targets_on_both_assemblies_are_pointed_out(grashof: Grashof, few: Result, tmp_path: Path) -> None:
    write_run(tmp_path, few, {}, drawings=0)
    listed = tmp_path / "candidates.json"
    content = json.loads(listed.read_text())
    content["designs"][0]["assembly"][-1] *= -1
    listed.write_text(json.dumps(content))
    said = "the targets need both assemblies"
    assert said in grashof("export", f"{listed}#1", "--scale", "1:50", "--svg", "a.svg").stdout
    assert said not in grashof("export", f"{listed}#2", "--scale", "1:50", "--svg", "a.svg").stdout


def test_all_three_at_once(grashof: Grashof, tmp_path: Path) -> None:
    files = ("--dxf", "jack.dxf", "--svg", "jack.svg", "--xlsx", "jack.xlsx")
    done = grashof("export", "pumpjack", "--scale", "1:20", *files)
    assert done.exit_code == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["jack.dxf", "jack.svg", "jack.xlsx"]
    assert done.stderr == "written: jack.dxf, jack.svg, jack.xlsx\n"
    for said in ("driver   1      1       5", "O2-A 59.69", "pin A", "output arm, 4.572 m", "full turn"):
        assert said in done.stdout
    notes = {e.dxf.text for e in ezdxf.readfile("jack.dxf").modelspace().query("TEXT")}
    assert "Pumpjack, crank-rocker, scale 1:20" in notes
    first = (tmp_path / "jack.svg").read_bytes()
    assert grashof("export", "pumpjack", "--scale", "0.05", "--svg", "jack.svg").exit_code == 0
    assert (tmp_path / "jack.svg").read_bytes() == first.replace(b"scale 1:20", b"scale 0.05")


@pytest.mark.extra
def test_every_format_has_an_option_and_is_written(grashof: Grashof, tmp_path: Path) -> None:
    pytest.importorskip("build123d")
    options = {parameter.name for parameter in get_command(app).commands["export"].params}  # type: ignore[attr-defined]
    assert {*FORMATS, WORKBOOK} <= options
    files = {name: f"jack{each.ending}" for name, each in FORMATS.items()}
    given = [word for name, file in files.items() for word in (f"--{name}", file)]
    done = grashof("export", "pumpjack", "--scale", "1:20", *given)
    assert done.exit_code == 0, done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(files.values())
    assert all((tmp_path / file).stat().st_size > 100 for file in files.values())


def test_models_need_no_plan(grashof: Grashof, tmp_path: Path) -> None:
    """A linkage in no unit, too short for its plates, has a model."""
    (tmp_path / "short.toml").write_text(PLAIN.replace("r2 = 30", "r2 = 3"))
    done = grashof("export", "short.toml", "--mujoco", "short.xml", "--geogebra", "short.ggb")
    assert (done.exit_code, done.stdout) == (0, ""), done.stderr
    assert grashof("export", "short.toml", "--mujoco", "short.xml", "--step", "short.step").exit_code == 2


def test_a_format_that_cannot_represent_a_linkage_is_refused(grashof: Grashof, tmp_path: Path) -> None:
    done = grashof("export", "crank-shaper", "--mujoco", "a.xml", "--linkage2", "a.linkage2")
    assert done.exit_code == 2
    why = "--linkage2 is for a four-bar or a slider-crank; Linkage has no block that swings about a pivot"
    assert done.stderr == f"written: a.xml\ngrashof: {why}\n"
    assert [path.name for path in tmp_path.iterdir()] == ["a.xml"]
    alone = grashof("export", "crank-shaper", "--linkage2", "a.linkage2")
    assert (alone.exit_code, alone.stderr) == (2, f"grashof: {why}\n")


def test_a_design_is_drawn_at_its_first_target(grashof: Grashof, few: Result, tmp_path: Path) -> None:
    write_run(tmp_path / "d", few, {}, drawings=0)
    done = grashof("export", "d/candidates.json#1", "--dxf", "one.dxf", "--scale", "1:50")
    assert done.exit_code == 0, done.stderr
    circles = ezdxf.readfile("one.dxf").modelspace().query("CIRCLE[layer=='ASSEMBLY_PINS']")
    o2, a = (complex(circle.dxf.center.x, circle.dxf.center.y) for circle in list(circles)[:2])
    crank = a - o2
    assert abs(crank) == pytest.approx(20 * float(few.best.linkage.r2), rel=1e-12)
    assert np.exp(1j * np.angle(crank)) == pytest.approx(np.exp(1j * few.best.verdict.theta2[0]))
    same = grashof("export", f"d/candidates.json#1,{few.best.id}", "--dxf", "two.dxf", "--scale", "1:50")
    assert same.exit_code == 0, same.stderr
    assert not [word for word in same.stdout.split() if len(word.strip(",").partition(".")[2]) > 3]
    several = grashof("export", "d/candidates.json#1,2", "--svg", "one.svg", "--xlsx", "one.xlsx")
    assert several.exit_code == 2
    assert several.stderr == "grashof: --svg takes one design; d/candidates.json#1,2 names 2\n"
    assert not (tmp_path / "one.xlsx").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("", "nothing to write; give a FILE for one or several of --dxf, --svg, --step,"),
        ("--dxf a.dwg", "--dxf a.dwg: the file name must end in .dxf"),
        ("--mujoco a.dat", "--mujoco a.dat: the file name must end in .xml"),
        ("--svg .", "--svg .: the file name must end in .svg"),
        (f"--svg {'x' * 300}.svg", "File name too long"),
        ("--svg no/a.svg", "--svg no/a.svg: there is no folder no"),
        ("--dxf a.dxf --mm-per-unit 1", "mm_per_unit is given, but length_unit of mine is mm"),
        ("--dxf a.dxf --hole 20", "hole is 20 mm; it must be less than the width, 20 mm"),
        ("--dxf a.dxf --width 0", "width in mm is 0; it must be a number greater than zero"),
        ("--dxf a.dxf --hole nan", "hole in mm is nan; it must be a finite number"),
        ("--dxf a.dxf --clearance 0", "clearance in mm is 0; it must be from 0.2 to 20"),
        ("--dxf a.dxf --width 60", "r2 is 30 mm; for width 60 and hole 6 mm it must be at least 33 mm"),
        ("--dxf a.dxf --scale 1:0", "scale is '1:0'; it must be a number above 0 or a ratio such as 1:20"),
        ("--dxf a.dxf --scale -2", "scale is '-2'"),
        ("--dxf a.dxf --scale 1000", "r1 is 100000 mm, over 1000 widths of 20 mm"),
        (
            "--dxf a.dxf --theta2-deg 90 10",
            "theta2 is 90 to 10 deg; it must be at most a turn, the lesser first",
        ),
        ("--dxf a.dxf --theta2-deg 0 nan", "theta2_deg is nan"),
        ("--dxf a.dxf --theta2-deg 0", "theta2-deg"),
    ],
)
def test_bad_input_is_one_line(grashof: Grashof, tmp_path: Path, arguments: str, said: str) -> None:
    (tmp_path / "mine.toml").write_text(f'length_unit = "mm"\n{PLAIN}')
    done = grashof("export", "mine.toml", *arguments.split())
    assert_one_line(done, 2, said)
    assert [path.name for path in tmp_path.iterdir()] == ["mine.toml"]


def test_other_length_units_need_millimetres(grashof: Grashof, tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(f'length_unit = "hand"\n{PLAIN}')
    done = grashof("export", "mine.toml", "--svg", "a.svg")
    assert_one_line(
        done, 2, "length_unit of mine is 'hand', not one of mm, cm, m, in, ft; give --mm-per-unit"
    )
    done = grashof("export", "mine.toml", "--svg", "a.svg", "--mm-per-unit", "101.6")
    assert done.exit_code == 0
    assert "O2-A 3048" in done.stdout
    assert grashof("export", "mine.toml", "--xlsx", "a.xlsx").exit_code == 0


@pytest.mark.parametrize(("library", "option"), [("ezdxf", "--dxf"), ("openpyxl", "--xlsx")])
def test_a_missing_library_is_named(
    grashof: Grashof, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, library: str, option: str
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    done = grashof("export", "pumpjack", option, f"a.{option[2:]}")
    assert done.exit_code == 2
    needs = f"{option[2:].upper()} needs {library}"
    assert done.stderr == f"grashof: {needs}: pip install 'grashof[export]' (in a clone '.[export]')\n"
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_older_files(
    grashof: Grashof, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def full(path: Path, content: bytes) -> int:
        if path.suffix == ".svg":
            raise OSError(28, "No space left on device")
        return write(path, content)

    write = Path.write_bytes
    (tmp_path / "a.dxf").write_text("before")
    monkeypatch.setattr(Path, "write_bytes", full)
    done = grashof("export", "pumpjack", "--dxf", "a.dxf", "--svg", "a.svg")
    assert done.exit_code == 3
    assert "No space left on device" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["a.dxf"]
    assert (tmp_path / "a.dxf").read_text() == "before"


def test_driver_and_output_share_a_layer_only_where_they_never_meet() -> None:
    apart = plan_parts(FourBar((0, 0), (160, 0), 20, 110, 90))
    assert layers(apart) == {"base": (0,), "driver": (1,), "coupler": (2,), "output": (1,)}
    near = plan_parts(FourBar((0, 0), (400, 0), 300, 100, 300))
    assert layers(near) == {"base": (0,), "driver": (1,), "coupler": (2,), "output": (3,), "spacer": (1, 2)}
    assert [(pin.name, pin.low, pin.high) for pin in near.pins] == [
        ("O2", 0, 1), ("A", 1, 2), ("B", 2, 3), ("O4", 0, 3),
    ]  # fmt: skip
    assert [near.pin_length(pin) for pin in near.pins] == [10, 10, 10, 20]


def test_a_drag_link_gets_a_second_base_with_the_reason() -> None:
    plan = plan_parts(DRAG)
    found = layers(plan)
    assert (found["base"], found["driver"], found["coupler"], found["output"]) == ((0, 4), (1,), (2,), (3,))
    assert "- driver and pin O4 meet at theta2 = 0.0 deg" in plan.notes
    posts = [pin for pin in plan.pins if pin.name.startswith("post")]
    assert [(pin.low, pin.high) for pin in posts] == [(0, 4), (0, 4)]


def test_part_of_the_motion_may_need_fewer_layers() -> None:
    low, high = np.radians([80, 150])
    part = plan_parts(DRAG, within=(low, high))
    assert part.layers < plan_parts(DRAG).layers
    assert low <= part.theta2 <= high
    assert "free for theta2 = 80.0 to 150.0 deg" in part.notes
    rocker = FourBar((0, 0), (400, 0), 300, 100, 300)
    with pytest.raises(
        ProblemError, match=r"it must be within 28.9\d+ to 67.9\d+ deg or -67.9\d+ to -28.9\d+ deg"
    ):
        plan_parts(rocker, within=(0, 1))
    one = plan_parts(rocker, theta2=float(np.radians(-50)))
    assert "free for theta2 = -68.0 to -29.0 deg, between the dead positions" in one.notes


def test_a_batch_or_a_bad_unit_is_refused() -> None:
    one = FourBar((0, 0), (100, 0), 30, 90, 80)
    with pytest.raises(ProblemError, match=r"linkage is a batch of shape \(1,\)"):
        plan_parts(one[None])
    with pytest.raises(ProblemError, match="mm_per_unit is 0"):
        plan_parts(one, mm_per_unit=0)

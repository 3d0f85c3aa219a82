"""Make the pictures of the pages: `python scripts/pictures.py`.

Writes into the folder given as the first argument, or into `docs`; some minutes, most of them the sweep.
"""

import re
import sys
from collections.abc import Sequence
from pathlib import Path

from matplotlib import rc_context
from matplotlib.figure import Figure
from symbols_picture import symbols

from grashof import load, plot_design_space, plot_kinematics, synthesize
from grashof.figures import draw_design, draw_motion, save, save_animation
from grashof.figures.files import STYLE
from grashof.problems import load_linkage_spec
from grashof.problems.files.problem_file import problem_of
from grashof.sweep import load_study, sweep
from grashof.sweep.plot import plot_sweep
from grashof.synth import Result

DOCS = Path(__file__).parents[1] / "docs"


def main(argv: Sequence[str] | None = None) -> int:
    """Picture the luggage problem, the pumpjack, the gripper of the tutorial, the sweep, and the symbols."""
    arguments = sys.argv[1:] if argv is None else argv
    folder = Path(arguments[0]) if arguments else DOCS
    folder.mkdir(parents=True, exist_ok=True)

    result = synthesize(load("luggage"), seed=0)
    save(draw_design(result.problem, result.best, 1), [folder / "luggage.png"])
    save_animation(draw_motion(result.best, result.problem, seconds=4, fps=12.5), folder / "luggage.gif")
    with rc_context(STYLE):
        space = Figure(figsize=(6.5, 4.5), layout="constrained")
        plot_design_space(result, ax=space.subplots())
        speeds = Figure(figsize=(6.5, 4.5), layout="constrained")
        quantities = ("angular velocity", "speed")
        axes = speeds.subplots(len(quantities), sharex=True)
        plot_kinematics(load_linkage_spec("pumpjack"), quantities=quantities, ax=axes)
        save(symbols(), [folder / "symbols.png"])
    save(space, [folder / "design-space.png"])
    save(speeds, [folder / "pumpjack-velocities.png"])
    gripper = gripper_of_the_tutorial()
    (folder / "tutorials").mkdir(exist_ok=True)
    save(draw_design(gripper.problem, gripper.best, 1), [folder / "tutorials" / "gripper.png"])
    done = sweep(load_study(DOCS / "longer-links.toml"))
    save(plot_sweep(done, done.to_frame()), [folder / "sweep.png"])
    return 0


def gripper_of_the_tutorial() -> Result:
    """The designs of the problem that the tutorial states, its targets with zones."""
    page = (DOCS / "tutorials" / "sketch-to-plates.md").read_text(encoding="utf-8")
    stated, zones, *_ = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    return synthesize(
        problem_of(stated.replace("[motion]\n", "[motion]\n" + zones), "gripper.toml", "gripper")
    )


if __name__ == "__main__":
    sys.exit(main())

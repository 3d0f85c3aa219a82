"""Make the pictures of the pages: `python scripts/pictures.py`.

Writes into the folder given as the first argument, or into `docs`; a minute at most.
"""

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

DOCS = Path(__file__).parents[1] / "docs"


def main(argv: Sequence[str] | None = None) -> int:
    """Solve the luggage problem, analyse the pumpjack, and picture both; and what symbols mean."""
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
    return 0


if __name__ == "__main__":
    sys.exit(main())

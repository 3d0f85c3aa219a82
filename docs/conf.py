"""How the pages are built: `sphinx-build -W --keep-going -b html docs build/docs`, without a network."""

from __future__ import annotations

import logging
import os
import sys
import warnings
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_ext"))
# Searches of a second or so gain nothing from threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

project = "Grashof"
author = "the authors of Grashof"
project_copyright = "the authors of Grashof"
release = version = installed("grashof")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
    "mathml",
    "reference",
]
exclude_patterns = ["_ext", "_templates", "gallery", "reference/generated/*.md"]
templates_path = ["_templates"]
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
default_role = "code"
add_module_names = False
python_use_unqualified_type_names = True
maximum_signature_line_length = 90

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
suppress_warnings = ["config.cache"]

autosummary_generate = True
autodoc_typehints = "none"  # numpydoc states types with shapes and units
numpydoc_show_class_members = False  # the template lists them

html_theme = "pydata_sphinx_theme"
html_title = "Grashof"
html_static_path = ["_static"]
html_css_files = ["grashof.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_copy_source = False
html_sidebars: dict[str, list[str]] = {"index": []}
html_theme_options: dict[str, Any] = {
    "navbar_align": "left",
    "navbar_end": ["theme-switcher"],
    "show_nav_level": 1,
    "show_toc_level": 2,
    "navigation_with_keys": False,
    "show_prev_next": False,
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "tango",
    "pygments_dark_style": "monokai",
}


def plain_figures(_gallery: dict[str, Any], _file: str) -> None:
    """Figures of all examples look alike; warnings that the text explains are silenced."""
    import matplotlib as mpl

    mpl.use("agg")
    mpl.rcParams.update(
        {
            "figure.figsize": (7.0, 4.4),
            "figure.constrained_layout.use": True,
            "savefig.dpi": 110,
            "font.size": 10,
            "axes.grid": True,
            "axes.axisbelow": True,
            "grid.color": "0.9",
            "axes.spines.top": False,
            "axes.spines.right": False,
            "legend.frameon": False,
        }
    )
    logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)
    warnings.filterwarnings("ignore", message="FigureCanvasAgg is non-interactive")


sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "examples",
    "filename_pattern": r"[\\/]\w+\.py$",
    "reset_modules": ("matplotlib", plain_figures),
    "parallel": True,  # as many examples at once as `-j` says
    "within_subsection_order": "gallery_order.Order",
    "write_computation_times": False,
    "min_reported_time": 1e6,
    "show_memory": False,
    "show_signature": False,
    "download_all_examples": False,
    "notebook_extensions": (),
    "remove_config_comments": True,
    "capture_repr": (),
    "abort_on_example_error": False,
    "only_warn_on_example_error": False,
    "default_thumb_file": None,
    "copyfile_regex": r"index\.rst",
}

"""The live page: a task edited by hand in the browser or a notebook, and the verified list that follows."""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING

from grashof.problems import Problem, ProblemError
from grashof.problems.values.errors import wrong_value

if TYPE_CHECKING:
    from grashof.live.widget import LiveWidget

__all__ = ["live"]


def live(problem: Problem | str = "luggage") -> LiveWidget:
    """The live page in a notebook.

    Parameters
    ----------
    problem : Problem or str
        Of the first page: a problem, or an argument of `load`.

    Returns
    -------
    LiveWidget
        To be shown; its `problem` and `designs` are those on the page.

    Raises
    ------
    ProblemError
        The problem is invalid, or anywidget is not installed.
    """
    if find_spec("anywidget") is None:
        raise ProblemError("live needs anywidget; pip install 'grashof[notebook]' installs it")
    if not isinstance(problem, Problem | str):
        raise wrong_value("problem", problem, "a Problem or a name")
    from grashof.live.widget import LiveWidget

    return LiveWidget(problem)

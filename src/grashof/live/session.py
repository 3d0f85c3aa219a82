"""Pages, each with the designs that it shows, and one job at a time: the newest."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import AsyncGenerator
from contextlib import aclosing
from dataclasses import dataclass, field, replace

from grashof.live.jobs import Job
from grashof.live.solvers import Solvers
from grashof.problems.values.errors import wrong_value

MOST_PAGES = 16
_MOST_NAME = 64


@dataclass(slots=True, eq=False)
class Session:
    """A page: its designs, as a solver wrote them, and its newest job; a job before that is left."""

    solvers: Solvers
    shown: bytes = b""
    newest: Job | None = None

    async def lines(self, job: Job) -> AsyncGenerator[str]:
        """Lines of a job, as JSON; they end early when the page asks for something newer.

        A file is made beside what else goes on.
        """
        aside = job.what == "file"
        if not aside:
            self.newest = job
        job = job if aside else replace(job, shown=self.shown)
        mine = self.newest

        def left() -> bool:
            return not aside and self.newest is not mine

        async with aclosing(self.solvers.lines(job, left)) as lines:
            async for line in lines:
                if line.shown is not None and not left():
                    self.shown = line.shown
                yield line.text


@dataclass(slots=True)
class Sessions:
    """Pages by their names; the one that was used longest ago is forgotten when there are many."""

    solvers: Solvers
    pages: OrderedDict[str, Session] = field(default_factory=OrderedDict)

    def of(self, page: object) -> Session:
        """The page of a name; ProblemError where it is none."""
        if not isinstance(page, str) or not 0 < len(page) <= _MOST_NAME:
            raise wrong_value("page", page, f"a name of up to {_MOST_NAME} characters")
        if page not in self.pages:
            self.pages[page] = Session(self.solvers)
            if len(self.pages) > MOST_PAGES:
                self.pages.popitem(last=False)
        self.pages.move_to_end(page)
        return self.pages[page]

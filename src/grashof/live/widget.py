"""The live page as a widget of notebooks."""

from __future__ import annotations

import asyncio
import json
from typing import Any

import anywidget

from grashof.live.front import widget_module
from grashof.live.requests import beginning, error_line, job_of, opened, request_of
from grashof.live.solvers import Session, Solvers
from grashof.problems import Problem, ProblemError
from grashof.problems.files.problem_schema import problem_from
from grashof.synth import Candidate


class LiveWidget(anywidget.AnyWidget):
    """A page in a cell, which begins with a problem; `problem` and `designs` are those on it."""

    _esm = widget_module()

    def __init__(self, problem: Problem | str) -> None:
        super().__init__()
        self._begin = beginning(problem)
        self._document, self._name = self._begin["document"], self._begin["name"]
        self._session = Session(Solvers())
        self._tasks: dict[int, asyncio.Task[None]] = {}
        self.on_msg(self._asked)

    @property
    def problem(self) -> Problem:
        """The problem on the page."""
        return problem_from(self._document, self._name)

    @property
    def designs(self) -> tuple[Candidate, ...]:
        """The designs on the page, best first where they come from a search."""
        from grashof.live.work import Shown

        return tuple(Shown.read(self._session.shown).designs.values())

    def close(self) -> None:
        """End the widget and its solvers."""
        self._session.solvers.end()
        super().close()

    def _asked(self, _widget: object, message: dict[str, Any], _buffers: object) -> None:
        """Answer a message of the page, beside other work of the kernel."""
        number = message.get("number")
        if not isinstance(number, int):
            return
        if message.get("leave"):
            if number in self._tasks:
                self._tasks[number].cancel()
            return
        task = asyncio.get_running_loop().create_task(self._answered(number, message))
        self._tasks[number] = task
        task.add_done_callback(lambda _: self._tasks.pop(number, None))

    async def _answered(self, number: int, message: dict[str, Any]) -> None:
        try:
            request = request_of(json.dumps(message.get("body")).encode())
            if message.get("what") == "begin":
                self.send({"number": number, "line": json.dumps(opened(self._begin, request))})
            else:
                await self._done(number, {**request, "what": message.get("what")})
        except ProblemError as error:
            self.send({"number": number, "line": error_line(*str(error).splitlines()).text})
        self.send({"number": number, "end": True})

    async def _done(self, number: int, request: dict[str, Any]) -> None:
        job = job_of(request)
        if job.what in ("track", "search"):
            self._document, self._name = job.document, job.name
        self._session.solvers.start()
        async for line in self._session.lines(job):
            self.send({"number": number, "line": line})

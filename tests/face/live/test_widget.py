"""The live page in a notebook: its frame in a browser, its messages answered in Python."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Coroutine
from typing import TYPE_CHECKING, Any

import pytest

from grashof import load, synthesize
from grashof.live import live
from grashof.problems import ProblemError

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from grashof.live.widget import LiveWidget

pytest.importorskip("anywidget")
pytestmark = pytest.mark.extra
Run = Callable[[Coroutine[Any, Any, Any]], Any]


class Model:
    """The notebook between the kernel and the page: messages both ways."""

    def __init__(self, widget: LiveWidget, monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
        self.widget, self.run, self.sent = widget, run, list[dict[str, Any]]()
        monkeypatch.setattr(widget, "send", self.sent.append)

    def ask(self, message: dict[str, Any]) -> list[dict[str, Any]]:
        """All that comes back of one message."""

        async def until_answered() -> None:
            self.widget._asked(self.widget, message, [])
            await asyncio.gather(*self.widget._tasks.values())

        self.sent.clear()
        self.run(until_answered())
        return list(self.sent)

    def lines(self, what: str, **body: Any) -> list[dict[str, Any]]:
        *answers, end = self.ask({"number": 7, "what": what, "body": body})
        assert end == {"number": 7, "end": True}
        return [json.loads(answer["line"]) for answer in answers]


@pytest.mark.slow
def test_the_widget_answers_as_the_server_does(monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    widget = live(load("luggage"))
    try:
        model = Model(widget, monkeypatch, run)
        (begun,) = model.lines("begin")
        assert begun["name"] == "luggage"
        document = begun["document"]
        document["motion"]["poses"][1][1] += 0.05
        model.lines("search", document=document, name="luggage")
        assert widget.problem.task.positions[1, 1] == 4.05
        expected = synthesize(widget.problem).top(50).candidates
        assert [one.id for one in widget.designs] == [one.id for one in expected]
        (refused,) = model.lines("search", document=[], name="luggage")
        assert refused == {"kind": "error", "lines": ["document is []; it must be a problem file as a table"]}
        assert model.ask({"what": "search"}) == []
    finally:
        widget.close()
    assert widget._session.solvers.every == []


@pytest.mark.study
def test_the_page_works_in_its_frame(browser: Browser, monkeypatch: pytest.MonkeyPatch, run: Run) -> None:
    widget = live("luggage")
    model = Model(widget, monkeypatch, run)
    module = f"{widget._esm}\nwindow.render = render;".replace("export default { render };", "")
    script = """
    const listeners = [];
    const tell = (messages) => { for (const m of messages) for (const l of listeners) l(m); };
    const model = {
      on: (_, listener) => listeners.push(listener),
      send: async (message) => {
        if (!message.leave) tell(JSON.parse(await window.askPython(JSON.stringify(message))));
      },
    };
    render({ model, el: document.body });
    """
    try:
        page = browser.new_page(viewport={"width": 1200, "height": 850})
        wrong: list[str] = []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.expose_function("askPython", lambda text: json.dumps(model.ask(json.loads(text))))
        page.evaluate(f"(() => {{ {module}\n {script} }})()")
        frame = page.frames[1]
        frame.wait_for_function("window.grashof && window.grashof.state().listed?.phase === 'found'")
        shown = frame.evaluate("window.grashof.state().designs.map((one) => one.id)")
        assert shown == [one.id for one in widget.designs]
        assert page.evaluate("getComputedStyle(document.body).marginTop") == "8px"
        page.close()
        assert wrong == []
    finally:
        widget.close()


def test_a_value_that_is_not_a_problem_is_refused() -> None:
    with pytest.raises(ProblemError, match="problem is 3; it must be a Problem or a name"):
        live(3)  # type: ignore[arg-type]
    with pytest.raises(ProblemError, match="neither a problem of the catalogue nor a file"):
        live("nothing")

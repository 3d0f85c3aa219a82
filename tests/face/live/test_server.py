"""The server of the live page: what it answers, and what it refuses."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

import httpx
import pytest

from grashof import load, synthesize, track
from grashof.live.server import HEADERS
from grashof.problems import problem_text
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_schema import problem_from

DOCUMENT = document_of(problem_text("luggage"), "luggage.toml")


class Client:
    """What a page asks, with its own token and origin."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        self.origin = f"{parts.scheme}://{parts.netloc}"
        self.headers = {"Origin": self.origin, "Grashof-Token": parts.fragment}
        self.http = httpx.Client(base_url=self.origin, timeout=60)

    def ask(self, what: str, document: dict[str, Any] = DOCUMENT, **more: Any) -> list[dict[str, Any]]:
        body = {"what": what, "document": document, "name": "luggage", "page": "one", **more}
        answer = self.http.post("/ask", json=body, headers=self.headers)
        return [json.loads(line) for line in answer.text.splitlines()]


@pytest.fixture(scope="module")
def client(served: str) -> Iterator[Client]:
    made = Client(served)
    yield made
    made.http.close()


def moved(by: float) -> dict[str, Any]:
    document: dict[str, Any] = json.loads(json.dumps(DOCUMENT))
    document["motion"]["poses"][1][1] += by
    return document


def linkages(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    lists = [line for line in lines if line["kind"] == "list"]
    return [design["linkage"] for design in lists[-1]["designs"]]


@pytest.mark.slow
def test_a_search_is_that_of_the_library_and_streams_designs_on_the_way(client: Client) -> None:
    lines = client.ask("search")
    phases = [line.get("phase") for line in lines if line["kind"] == "list"]
    assert phases[0] == "searching"
    assert phases[-1] == "found"
    expected = synthesize(load("luggage")).top(50)
    assert linkages(lines) == [{"mechanism": "four-bar", **one.linkage.stated} for one in expected.candidates]


@pytest.mark.slow
def test_designs_are_followed_as_the_library_follows_them_and_keep_their_keys(client: Client) -> None:
    found = client.ask("search", page="following")
    keys = [design["key"] for design in found[-2]["designs"]][:10]
    designs = synthesize(load("luggage")).top(50).candidates[:10]
    for step in (0.05, 0.1, 0.15):
        lines = client.ask("track", moved(step), page="following")
        designs = track(designs, problem_from(moved(step), "luggage"))
        assert all(one.verdict.ok for one in designs)
        assert [design["key"] for design in lines[0]["designs"]] == keys
        assert linkages(lines) == [{"mechanism": "four-bar", **one.linkage.stated} for one in designs]


@pytest.mark.slow
def test_lost_designs_are_named_with_what_they_miss_and_come_back(client: Client) -> None:
    client.ask("search", page="losing")
    strict = json.loads(json.dumps(DOCUMENT))
    strict["requirements"]["size"] = [0, 5]
    (lost, _) = client.ask("track", strict, page="losing")
    assert lost["designs"] == []
    assert len(lost["lost"]) == 10
    assert all("size" in each["why"] for each in lost["lost"])
    (back, _) = client.ask("track", page="losing")
    assert len(back["designs"]) == 10


@pytest.mark.slow
def test_pages_have_their_own_designs(client: Client) -> None:
    client.ask("search", page="mine")
    assert client.ask("track", page="another")[0]["designs"] == []


@pytest.mark.slow
def test_leaving_ends_the_work(client: Client) -> None:
    """More searches are left than there are solvers; each of them would take far longer than a second."""
    long = {"what": "search", "document": document_of(problem_text("straight-line"), "x"), "name": "x"}
    for page in ("left 1", "left 2", "left 3"):
        body = {**long, "page": page, "document": {**long["document"], "search": {"effort": 4}}}
        with client.http.stream("POST", "/ask", json=body, headers=client.headers) as answer:
            next(answer.iter_lines())
    since = monotonic()
    assert client.ask("search", page="after")[-1]["kind"] == "done"
    assert monotonic() < since + 10


def test_what_is_no_task_is_told_line_by_line(client: Client) -> None:
    wrong = {**DOCUMENT, "motion": {"poses": [[0, 0, 0]], "bodies": 1}}
    (error, _) = client.ask("search", wrong)
    assert error["kind"] == "error"
    assert any("motion.bodies is unknown" in line for line in error["lines"])
    assert len(error["lines"]) == 2


@pytest.mark.slow
def test_without_a_design_the_closest_misses_are_listed_with_what_to_relax(client: Client) -> None:
    strict = json.loads(json.dumps(DOCUMENT))
    strict["requirements"]["transmission_min_deg"] = 60
    *_, last, _ = client.ask("search", strict, page="vain")
    assert last["found"] is False
    assert last["designs"]
    assert last["designs"][0]["misses"]
    assert "transmission_min_deg" in last["note"]


@pytest.mark.slow
@pytest.mark.quick("designs")
@pytest.mark.parametrize("wanted", ["problem", "list", "designs", "report", "dxf"])
def test_files_are_those_of_the_command_line(client: Client, wanted: str) -> None:
    found = client.ask("search", page="saving")
    key = found[-2]["designs"][2]["key"]
    (file, _) = client.ask("file", page="saving", file=wanted, key=key)
    result = synthesize(load("luggage")).top(50)
    text = file["text"]
    if wanted == "problem":
        again = problem_from(document_of(text, "luggage.toml"), "luggage")
        assert [one.id for one in synthesize(again).candidates] == [
            one.id for one in synthesize(load("luggage")).candidates
        ]
    elif wanted == "list":
        assert [line.split(",")[1] for line in text.splitlines()[1:]] == [one.id for one in result.candidates]
    elif wanted == "designs":
        assert [one["id"] for one in json.loads(text)["designs"]] == [one.id for one in result.candidates]
    elif wanted == "report":
        assert text.startswith("<!doctype html>")
        assert all(one.id in text for one in result.candidates)
    else:
        assert result.candidates[2].id in file["name"]
        assert text.rstrip().endswith("EOF")


def test_a_dxf_drawing_comes_back_as_polylines(client: Client) -> None:
    import io

    import ezdxf

    document, text = ezdxf.new(), io.StringIO()
    document.modelspace().add_line((1, 2), (3, 4))
    document.write(text)
    (lines, _) = client.ask("outline", text=text.getvalue())
    assert lines["polylines"] == [[[1.0, 2.0], [3.0, 4.0]]]
    (error, _) = client.ask("outline", text="no drawing")
    assert error["lines"][0].startswith("is not a DXF file")


# ------------------------------------------------------------------------------------- what is refused


def refused(answer: httpx.Response) -> str:
    assert answer.status_code >= 400
    (line,) = answer.json()["lines"]
    return str(line)


def test_without_the_token_or_from_elsewhere_nothing_is_answered(client: Client) -> None:
    body = {"what": "search", "document": DOCUMENT, "page": "one"}
    token, elsewhere = "token", "does not come from the live page"
    wrong: tuple[tuple[dict[str, str | bytes], str], ...] = (
        ({"Origin": client.origin}, token),
        ({**client.headers, "Grashof-Token": "é".encode("latin-1")}, token),
        ({**client.headers, "Origin": "http://example.com"}, elsewhere),
        ({"Grashof-Token": client.headers["Grashof-Token"]}, elsewhere),
    )
    for path in ("/ask", "/begin"):
        for headers, told in wrong:
            assert told in refused(client.http.post(path, json=body, headers=headers))
        assert client.http.get(path).status_code == 405


def test_another_host_is_refused(client: Client) -> None:
    for host in ("example.com", "example.com:80", "127.0.0.1.example.com"):
        answer = client.http.get("/", headers={"Host": host})
        assert answer.status_code == 400
        assert "script" not in answer.text


def test_nothing_is_served_beyond_loopback(client: Client) -> None:
    port = int(urlsplit(client.origin).port or 0)
    others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for address in others - {"127.0.0.1"}:
        with socket.socket() as tried:
            tried.settimeout(2)
            assert tried.connect_ex((address, port)) != 0


@pytest.mark.parametrize(
    ("body", "told"),
    [
        (b"x" * 10_000_000, "the request has 10000000 bytes; at most 1000000 are allowed"),
        (b'{"what": "search", "document": {"a": NaN}}', "the request is not JSON with finite numbers"),
        (b"[" * 100_000, "the request is not JSON with finite numbers"),
        (b"[1]", "the request must be a table"),
        (b"{}", "page is None; it must be a name of up to 64 characters"),
        (b'{"page": "one"}', "what is None; it must be one of track, search, file, outline"),
        (b'{"page": "one", "what": "search"}', "document is None; it must be a problem file as a table"),
        (b'{"page": "1", "what": "track", "document": {}, "keys": [1.5]}', "keys is 1.5; it must be the number of a design"),  # noqa: E501
    ],
)  # fmt: skip
def test_malformed_requests_are_refused_in_a_line(client: Client, body: bytes, told: str) -> None:
    answer = client.http.post("/ask", content=body, headers=client.headers)
    assert refused(answer) == told


def test_a_body_without_a_length_is_cut_off(client: Client) -> None:
    parts = (b"x" * 100_000 for _ in range(100))
    answer = client.http.post("/ask", content=parts, headers=client.headers)
    assert refused(answer) == "the request has more than 1000000 bytes"


def test_work_has_limits(client: Client) -> None:
    many = {**DOCUMENT, "motion": {"poses": [[k, 0, 0] for k in range(500)]}}
    deep: Any = 0
    for _ in range(50):
        deep = [deep]
    corners = {"outlines": [[[0, 0]] * 5000]}
    cases = {
        "the task has 500 targets; the live page takes at most 200": many,
        "areas and outlines have 5000 corners; at most 1000 are drawn": {**DOCUMENT, "scene": corners},
        "the document has tables in each other more than 12 deep": {**DOCUMENT, "scene": {"outlines": deep}},
        "search.effort is 20; the live page takes at most 4": {**DOCUMENT, "search": {"effort": 20}},
    }  # fmt: skip
    for told, document in cases.items():
        body = {"what": "search", "document": document, "page": "one", "name": "x"}
        assert refused(client.http.post("/ask", json=body, headers=client.headers)) == told


def test_every_answer_has_the_headers_and_files_are_named_by_nobody(client: Client) -> None:
    for path in ("/", "/live.js", "/live.css", "/start.js", "/nothing"):
        answer = client.http.get(path)
        assert answer.status_code == (404 if path == "/nothing" else 200)
        assert {name: answer.headers[name] for name in HEADERS} == HEADERS
    named = {**DOCUMENT, "dynamics": {**DOCUMENT["dynamics"], "loads": [{"table": "/etc/passwd"}]}}
    error = client.ask("search", named)[0]
    assert error["kind"] == "error"
    assert "root" not in json.dumps(error)
    (error, _) = client.ask("file", file="problem", name="../../x")
    assert error["name"] == "x.toml"


def test_a_problem_is_opened_by_its_text_or_from_the_catalogue(client: Client) -> None:
    begun = client.http.post("/begin", json={}, headers=client.headers).json()
    assert begun["name"] == "luggage"
    assert begun["document"] == DOCUMENT
    assert "nine-points" in begun["catalogue"]
    chosen = client.http.post("/begin", json={"catalogue": "path-gait"}, headers=client.headers).json()
    assert chosen["document"]["kind"] == "path"
    text = problem_text("luggage").replace("3.5", "3.25")
    read = client.http.post(
        "/begin", json={"text": text, "name": "my luggage"}, headers=client.headers
    ).json()
    assert (read["name"], read["document"]["motion"]["poses"][1][0]) == ("my-luggage", 3.25)
    wrong = client.http.post("/begin", json={"text": 'kind = "nothing"'}, headers=client.headers)
    assert wrong.status_code == 422
    assert "kind" in wrong.json()["lines"][0]

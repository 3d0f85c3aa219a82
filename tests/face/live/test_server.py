"""The server of the live page: its answers and refusals."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from contextlib import closing
from copy import deepcopy
from pathlib import Path
from threading import Thread
from time import monotonic
from typing import Any
from urllib.parse import urlsplit

import httpx
import pytest
from uvicorn import Config, Server

from grashof import load, synthesize, track
from grashof.live.requests import beginning
from grashof.live.server import HEADERS, HOST, Live, application
from grashof.live.solvers import Solvers
from grashof.output.run_files import write_run
from grashof.problems import load_linkage_spec, problem_text
from grashof.problems.files.design_link import SharedDesign, design_link, read_link
from grashof.problems.files.linkage_writing import linkage_toml, mail_toml
from grashof.problems.files.on_disk import document_of
from grashof.problems.files.problem_schema import problem_from

DOCUMENT = document_of(problem_text("luggage"), "luggage.toml")


class Client:
    """Requests of a page, with its token and origin."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        self.origin = f"{parts.scheme}://{parts.netloc}"
        self.headers = {"Origin": self.origin, "Grashof-Token": parts.fragment}
        # However long an answer takes; no connection is kept, which the server may be closing.
        alone = httpx.Limits(max_keepalive_connections=0)
        self.http = httpx.Client(base_url=self.origin, timeout=None, limits=alone)  # noqa: S113

    def ask(self, what: str, document: dict[str, Any] = DOCUMENT, **more: Any) -> list[dict[str, Any]]:
        body = {"what": what, "document": document, "name": "luggage", "page": "one", **more}
        answer = self.http.post("/ask", json=body, headers=self.headers)
        return [json.loads(line) for line in answer.text.splitlines()]


@pytest.fixture(scope="module")
def client(served: str) -> Iterator[Client]:
    made = Client(served)
    yield made
    made.http.close()


@pytest.fixture(scope="module")
def local() -> Iterator[Client]:
    """The server in a thread, without solvers: for requests that need none."""
    with closing(socket.create_server((HOST, 0))) as own:
        live = Live(beginning("luggage"), own.getsockname()[1], solvers=Solvers(warm=0))
        server = Server(Config(application(live), log_level="error"))
        thread = Thread(target=server.run, kwargs={"sockets": [own]})
        thread.start()
        made = Client(live.address)
        yield made
        made.http.close()
        server.should_exit = True
        thread.join()


def moved(by: float) -> dict[str, Any]:
    document = deepcopy(DOCUMENT)
    document["motion"]["poses"][1][1] += by
    return document


def listed(lines: list[dict[str, Any]]) -> dict[str, Any]:
    """The last list."""
    return [line for line in lines if line["kind"] == "list"][-1]


def linkages(lines: list[dict[str, Any]]) -> list[dict[str, Any]]:
    return [design["linkage"] for design in listed(lines)["designs"]]


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
        assert [design["key"] for design in listed(lines)["designs"]] == keys
        assert linkages(lines) == [{"mechanism": "four-bar", **one.linkage.stated} for one in designs]


@pytest.mark.slow
def test_pages_have_their_own_designs(client: Client) -> None:
    client.ask("search", page="mine")
    assert listed(client.ask("track", page="another"))["designs"] == []


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


@pytest.mark.slow
def test_without_a_design_the_closest_misses_are_listed_with_a_relaxation(client: Client) -> None:
    strict = DOCUMENT | {"requirements": DOCUMENT["requirements"] | {"transmission_min_deg": 60}}
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


def link_of(linkage: str, document: dict[str, Any] = DOCUMENT) -> str:
    return design_link(SharedDesign("luggage", document, linkage), "http://127.0.0.1/")


@pytest.mark.slow
def test_a_design_is_shared_as_a_link_or_as_the_file_that_show_prints(client: Client, tmp_path: Path) -> None:
    found = client.ask("search", page="sharing")
    design = listed(found)["designs"][3]
    asked = {"page": "sharing", "key": design["key"], "address": "http://127.0.0.1:9/"}
    (file, _) = client.ask("file", file="linkage", **asked)
    write_run(tmp_path, synthesize(load("luggage")).top(50), {}, 0)
    spec = load_linkage_spec(f"{tmp_path}/candidates.json#4")
    assert file["text"] == mail_toml(spec)
    (link, _) = client.ask("file", file="link", **asked)
    assert link["text"].startswith("http://127.0.0.1:9/#design=")
    assert load_linkage_spec(link["text"]).linkage.stated == spec.linkage.stated
    begun = client.http.post("/begin", json={"link": link["text"]}, headers=client.headers).json()
    assert (begun["document"], begun["name"], begun["given"]) == (DOCUMENT, "luggage", file["text"])
    given = client.ask("search", page="recipient", given=begun["given"])
    lists = [line for line in given if line["kind"] == "list"]
    assert [lists[0]["designs"][0]["linkage"]] == [design["linkage"]]  # before any is searched for
    assert linkages(given) == linkages(found)  # which have it already
    (alone, _) = client.ask("file", page="nobody", file="problem-link", address="http://127.0.0.1:9/")
    assert read_link(alone["text"]).linkage == ""


@pytest.mark.slow
@pytest.mark.parametrize(("least", "found"), [(15, True), (60, False)])
def test_a_design_of_a_link_that_misses_is_listed_with_its_defects(
    client: Client, least: float, found: bool
) -> None:
    """It is not taken for verified, whether the search finds others or not."""
    document = DOCUMENT | {"requirements": DOCUMENT["requirements"] | {"transmission_min_deg": least}}
    linkage = "o2 = [0, 0]\no4 = [4, 0]\nr2 = 1\nr3 = 4\nr4 = 3\ncoupler_point = [2, 1]"
    lines = client.ask("search", document, page=f"miss {least}", given=linkage)
    first, last = next(line for line in lines if line["kind"] == "list"), listed(lines)
    (design,) = first["designs"]
    assert [each["key"] for each in first["lost"]] == [design["key"]]
    assert last["found"] is found
    assert last["designs"][-1]["key"] == design["key"]
    assert len(last["designs"]) > 1
    assert design["misses"] == last["designs"][-1]["misses"] != ""
    assert bool(last["note"]) is not found


# ------------------------------------------------------------------------------------------ refusals


def refused(answer: httpx.Response) -> str:
    assert answer.status_code >= 400
    (line,) = answer.json()["lines"]
    return str(line)


def test_without_the_token_or_from_elsewhere_nothing_is_answered(local: Client) -> None:
    body = {"what": "search", "document": DOCUMENT, "page": "one"}
    token, elsewhere = "token", "does not come from the live page"
    wrong: tuple[tuple[dict[str, str | bytes], str], ...] = (
        ({"Origin": local.origin}, token),
        ({**local.headers, "Grashof-Token": "é".encode("latin-1")}, token),
        ({**local.headers, "Origin": "http://example.com"}, elsewhere),
        ({"Grashof-Token": local.headers["Grashof-Token"]}, elsewhere),
    )
    for path in ("/ask", "/begin"):
        for headers, line in wrong:
            assert line in refused(local.http.post(path, json=body, headers=headers))
        assert local.http.get(path).status_code == 405


def test_another_host_is_refused(local: Client) -> None:
    for host in ("example.com", "example.com:80", "127.0.0.1.example.com"):
        answer = local.http.get("/", headers={"Host": host})
        assert answer.status_code == 400
        assert "script" not in answer.text


@pytest.mark.slow
def test_nothing_is_served_beyond_loopback(client: Client) -> None:
    port = int(urlsplit(client.origin).port or 0)
    others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for address in others - {"127.0.0.1"}:
        with socket.socket() as tried:
            tried.settimeout(2)
            assert tried.connect_ex((address, port)) != 0


@pytest.mark.parametrize(
    ("body", "line"),
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
def test_malformed_requests_are_refused_in_a_line(local: Client, body: bytes, line: str) -> None:
    answer = local.http.post("/ask", content=body, headers=local.headers)
    assert refused(answer) == line


def test_a_body_without_a_length_is_cut_off(local: Client) -> None:
    parts = (b"x" * 100_000 for _ in range(100))
    answer = local.http.post("/ask", content=parts, headers=local.headers)
    assert refused(answer) == "the request has more than 1000000 bytes"


def test_work_has_limits(local: Client) -> None:
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
    for line, document in cases.items():
        body = {"what": "search", "document": document, "page": "one", "name": "x"}
        assert refused(local.http.post("/ask", json=body, headers=local.headers)) == line


def test_every_answer_has_the_headers(local: Client) -> None:
    for path in ("/", "/live.js", "/live.css", "/start.js", "/nothing"):
        answer = local.http.get(path)
        assert answer.status_code == (404 if path == "/nothing" else 200)
        assert {name: answer.headers[name] for name in HEADERS} == HEADERS


def test_a_problem_is_opened_by_its_text_or_from_the_catalogue(local: Client) -> None:
    begun = local.http.post("/begin", json={}, headers=local.headers).json()
    assert begun["name"] == "luggage"
    assert begun["document"] == DOCUMENT
    assert "nine-points" in begun["catalogue"]
    chosen = local.http.post("/begin", json={"catalogue": "path-gait"}, headers=local.headers).json()
    assert chosen["document"]["kind"] == "path"
    text = problem_text("luggage").replace("3.5", "3.25")
    read = local.http.post("/begin", json={"text": text, "name": "my luggage"}, headers=local.headers).json()
    assert (read["name"], read["document"]["motion"]["poses"][1][0]) == ("my-luggage", 3.25)
    linkage = linkage_toml(load_linkage_spec("luggage-report"))
    shared = local.http.post("/begin", json={"link": link_of(linkage)}, headers=local.headers).json()
    assert (shared["document"], shared["given"]) == (DOCUMENT, linkage)
    wrong = local.http.post("/begin", json={"text": 'kind = "nothing"'}, headers=local.headers)
    assert wrong.status_code == 422
    assert "kind" in wrong.json()["lines"][0]


@pytest.mark.parametrize(
    ("link", "line"),
    [
        (link_of("")[:-3], "the link is damaged or cut off"),
        ("http://127.0.0.1/#design=foreign", "the link is damaged or cut off"),
        ("http://example.com/#section", "the link has no design of grashof live in its fragment"),
        (link_of("r2 = 1\nr3 = 2\nr4 = -3\no2 = [0, 0]\no4 = [1, 0]"), "the link: r4 is -3"),
        (link_of("", {"kind": "dance"}), "the link: kind is 'dance'"),
        (link_of("", DOCUMENT | {"search": {"effort": 20}}), "search.effort is 20; the live page takes"),
        (7, "link must be that of a design"),
    ],
)
def test_damaged_and_foreign_links_are_refused_in_a_line(local: Client, link: object, line: str) -> None:
    assert line in refused(local.http.post("/begin", json={"link": link}, headers=local.headers))

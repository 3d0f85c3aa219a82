"""The server of the live page: on this machine alone, for one browser that has its token."""

from __future__ import annotations

import secrets
from collections.abc import AsyncGenerator, AsyncIterator, Awaitable, Callable
from contextlib import aclosing, asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route

from grashof.live.front import FRONT
from grashof.live.requests import MOST_BYTES, error_line, job_of, opened, request_of
from grashof.live.solvers import Sessions, Solvers
from grashof.problems import ProblemError

HOST = "127.0.0.1"
TOKEN = "Grashof-Token"  # noqa: S105  (the name of the header)
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' blob: data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}
_LOST = "the token is missing or wrong; open the address that grashof live prints, and a link on its page"
JSON_LINES = "application/x-ndjson"


@dataclass(frozen=True, slots=True)
class Live:
    """A server: `begin` has the "document" and "name" of a new page; host and `port` are its origin.

    Every request needs the token, which the page has from the fragment of its address.
    """

    begin: dict[str, Any]
    port: int
    token: str = field(default_factory=lambda: secrets.token_urlsafe(24))
    solvers: Solvers = field(default_factory=Solvers)

    @property
    def origin(self) -> str:
        """Origin of the page."""
        return f"http://{HOST}:{self.port}"

    @property
    def address(self) -> str:
        """Address for the browser."""
        return f"{self.origin}/#{self.token}"


def application(live: Live) -> Starlette:
    """The application: the page, its style and scripts, and the answers to its requests."""
    sessions = Sessions(live.solvers)

    async def front(request: Request) -> Response:
        content, kind = FRONT[request.url.path]()
        return Response(content, media_type=kind)

    async def begin(_request: Request, body: dict[str, Any]) -> Response:
        return JSONResponse(opened(live.begin, body))

    async def ask(_request: Request, body: dict[str, Any]) -> Response:
        session = sessions.of(body.get("page"))
        job = job_of(body, session.shown)
        return StreamingResponse(_until_left(session.lines(job)), media_type=JSON_LINES)

    @asynccontextmanager
    async def lifespan(_app: Starlette) -> AsyncIterator[None]:
        live.solvers.start()
        try:
            yield
        finally:
            live.solvers.end()

    return Starlette(
        routes=[
            *(Route(path, front) for path in FRONT),
            Route("/begin", _guarded(live, begin), methods=["POST"]),
            Route("/ask", _guarded(live, ask), methods=["POST"]),
        ],
        middleware=[
            Middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"], www_redirect=False),
            Middleware(_Headers),
        ],
        lifespan=lifespan,
    )


async def _until_left(lines: AsyncGenerator[str]) -> AsyncIterator[str]:
    """Lines of a job, which ends when the request is closed."""
    async with aclosing(lines):
        async for line in lines:
            yield line + "\n"


Answer = Callable[[Request, dict[str, Any]], Awaitable[Response]]


def _guarded(live: Live, answer: Answer) -> Callable[[Request], Awaitable[Response]]:
    """Answer only requests of our own page."""

    async def guarded(request: Request) -> Response:
        if request.headers.get("origin") != live.origin:
            return _refused(403, "the request does not come from the live page")
        if not secrets.compare_digest(request.headers.get(TOKEN, "").encode(), live.token.encode()):
            return _refused(403, _LOST)
        try:
            body = await _body(request)
            return await answer(request, request_of(body))
        except ClientDisconnect:
            return Response(status_code=499)
        except ProblemError as error:
            return _refused(413 if "bytes" in str(error) else 422, *str(error).splitlines())

    return guarded


async def _body(request: Request) -> bytes:
    """The body; ProblemError where it is too large."""
    length = request.headers.get("content-length", "")
    if length.isdecimal() and int(length) > MOST_BYTES:
        raise ProblemError(f"the request has {length} bytes; at most {MOST_BYTES} are allowed")
    body = b""
    async for part in request.stream():
        body += part
        if len(body) > MOST_BYTES:
            raise ProblemError(f"the request has more than {MOST_BYTES} bytes")
    return body


def _refused(status: int, *lines: str) -> Response:
    return Response(error_line(*lines).text, status, media_type="application/json")


class _Headers:
    """Headers that every answer has."""

    def __init__(self, app: Any) -> None:
        self._app = app

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        async def send_with(message: Any) -> None:
            if message["type"] == "http.response.start":
                message["headers"] += [(k.lower().encode(), v.encode()) for k, v in HEADERS.items()]
            await send(message)

        await self._app(scope, receive, send_with if scope["type"] == "http" else send)

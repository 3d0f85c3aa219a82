"""`grashof live`: a server on this machine, and the browser on its page."""

from __future__ import annotations

import webbrowser
from contextlib import closing, suppress
from importlib.util import find_spec
from socket import AF_INET, SO_REUSEADDR, SOCK_STREAM, SOL_SOCKET, socket

from grashof.live.asked import beginning
from grashof.output.ending import ExitCode
from grashof.output.streams import say
from grashof.problems import ProblemError, SolverError

NEEDED = ("starlette", "uvicorn")


def live(problem: str | None, port: int, *, browser: bool) -> ExitCode:
    """Serve the live page of a problem, by name or file, until Ctrl-C; port 0 takes a free one.

    ProblemError where the problem is invalid or what `grashof[live]` installs is missing; SolverError where
    the port is taken.
    """
    if any(find_spec(name) is None for name in NEEDED):
        raise ProblemError(
            "grashof live needs Starlette and uvicorn; pip install 'grashof[live]' installs them"
        )
    from uvicorn import Config, Server

    from grashof.live.server import HOST, Live, application

    begin = beginning(problem)
    with closing(socket(AF_INET, SOCK_STREAM)) as own:
        own.setsockopt(SOL_SOCKET, SO_REUSEADDR, 1)
        try:
            own.bind((HOST, port))
        except OSError as error:
            raise SolverError(f"--port {port}: {error.strerror}; 0 takes a free one") from None
        served = Live(begin, own.getsockname()[1])
        say(f"{served.address}\nThe page of {begin['name']}, for this machine alone. Ctrl-C ends it.")
        if browser:
            webbrowser.open(served.address)
        config = Config(
            application(served), log_level="warning", access_log=False, timeout_graceful_shutdown=2
        )
        with suppress(KeyboardInterrupt):  # uvicorn raises it again once all is closed
            Server(config).run(sockets=[own])
    return ExitCode.OK

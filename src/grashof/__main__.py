"""The `grashof` command, also as `python -m grashof`: it can be interrupted while it is being loaded."""

import os
import sys

TYPE_CHECKING = False  # as in `typing`, which takes as long to load as Python itself
if TYPE_CHECKING:
    from types import FrameType

_WIDTH = 80  # columns up to which Typer lays out help
_INTERRUPTED = 130  # 128 + SIGINT


def main() -> None:
    """Entry point of the `grashof` command."""
    if sys.argv[1:] == ["--help"] and _columns() >= _WIDTH and _help_printed():
        return
    import atexit
    import gc
    import signal

    gc.set_threshold(200_000)  # most objects stay: 85 000 of a search are modules, and a scan takes 50 ms
    atexit.register(gc.freeze)  # a scan at the end takes 0.15 s
    before = signal.getsignal(signal.SIGINT)
    if before is not signal.SIG_IGN:  # as of jobs in the background
        signal.signal(signal.SIGINT, _leave)
    from grashof.cli import main as command

    signal.signal(signal.SIGINT, before)
    command()


def _columns() -> int:
    """Width of the terminal, as `shutil.get_terminal_size` has it, which takes as long to load as Python."""
    try:
        return int(os.environ["COLUMNS"]) or _terminal_columns()
    except (KeyError, ValueError):
        return _terminal_columns()


def _terminal_columns() -> int:
    try:
        return os.get_terminal_size(sys.stdout.fileno()).columns or _WIDTH
    except (AttributeError, OSError, ValueError):  # no terminal
        return _WIDTH


def _help_printed() -> bool:
    """Print what Typer prints for ``--help``, from `help.txt`, without loading it; False if that fails."""
    try:
        with open(f"{os.path.dirname(__file__)}/help.txt", encoding="ascii") as text:  # noqa: PTH120, PTH123
            print(text.read(), end="", flush=True)  # noqa: T201
    except (AttributeError, OSError, ValueError):  # the command reports it
        return False
    return True


def _leave(_number: int, _frame: "FrameType | None") -> None:
    """End at once: compiled modules make other errors of a `KeyboardInterrupt`, and nothing has begun yet."""
    os.write(2, b"grashof: interrupted\n")
    os._exit(_INTERRUPTED)


if __name__ == "__main__":
    main()

"""The errors Grashof raises, all under `GrashofError`."""


class GrashofError(Exception):
    """Base of every error that Grashof raises on purpose."""


class ProblemError(GrashofError, ValueError):
    """Bad input: the message names what is wrong, where, and what it must be."""


def wrong_value(where: str, value: object, wanted: str) -> ProblemError:
    """The error of a value that is not what it must be."""
    return ProblemError(f"{where} is {value!r}; it must be {wanted}")


class AssemblyError(GrashofError):
    """A linkage cannot be assembled where a position was asked for."""


class NoSolutionError(GrashofError):
    """No verified design exists in a result; the message states why."""


class SolverError(GrashofError):
    """Environment error of a search: a worker died, an executor was lost."""


class GrashofWarning(UserWarning):
    """Base of every warning that Grashof gives on purpose."""


class DeadPositionWarning(GrashofWarning):
    """A dead position of the driver: links 3 and 4 would move infinitely fast there."""

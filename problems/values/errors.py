"""The errors Grashof raises, all under `GrashofError`."""


class GrashofError(Exception):
    """Base of every error that Grashof raises on purpose."""


class ProblemError(GrashofError, ValueError):
    """Bad input: the message names what is wrong, where, and what is allowed."""


class AssemblyError(GrashofError):
    """A linkage cannot be assembled where a position was asked for."""


class NoSolutionError(GrashofError):
    """No verified design exists in a result; the message says what stood in the way."""


class SolverError(GrashofError):
    """The surroundings of the search failed: a worker died, an executor was lost."""


class GrashofWarning(UserWarning):
    """Base of every warning that Grashof gives on purpose."""


class DeadPositionWarning(GrashofWarning):
    """A dead position of the driver: links 3 and 4 would move infinitely fast there."""

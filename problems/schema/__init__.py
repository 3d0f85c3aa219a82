"""Problem and linkage files described: their keys in words, and their JSON Schema."""

from enum import StrEnum


class FileKind(StrEnum):
    """The files that have a schema."""

    PROBLEM = "problem"
    LINKAGE = "linkage"

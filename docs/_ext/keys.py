"""The keys of files as tables in Markdown."""

from __future__ import annotations

from marking import row

from grashof.problems.files.linkage_schema import FILES, LinkageTable
from grashof.problems.files.tables import Table, tables_of
from grashof.problems.schema.docstrings import code
from grashof.problems.schema.keys import described_keys
from grashof.sweep.study import StudyFile


def study_tables() -> dict[str, type[Table]]:
    """Tables of study files."""
    return dict(tables_of(StudyFile))


def key_table(table: type[Table]) -> str:
    """The keys of a table as a table in Markdown; of a kind of linkage those that not all kinds have."""
    shared = LinkageTable.model_fields if table in FILES.values() else ()
    head = [row("key", "value", "unit", "default", "meaning"), "|---|---|---|---|---|"]
    body = [
        row(code(key.name), key.value, key.unit, key.default, key.text)
        for key in described_keys(table)
        if key.name not in shared
    ]
    return "\n".join([*head, *body])

"""The JSON Schema (draft 2020-12) of problem and linkage files."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue, models_json_schema
from pydantic_core import CoreSchema, core_schema

from grashof.problems.files.linkage_schema import FILES
from grashof.problems.files.problem_schema import ProblemFile
from grashof.problems.files.tables import Table
from grashof.problems.schema import FileKind
from grashof.problems.schema.keys import Key, described_keys, summary
from grashof.problems.schema.shapes import Shape, conditions, kinds_of, shape_of


def json_schema(file: FileKind) -> dict[str, Any]:
    """The schema of a kind of file; keys are described as in the reference.

    Every file that `load` or `load_linkage` accepts conforms to it. It refuses unknown keys, words and kinds
    and values of another type, but does not know every limit of a number, nor what keys mean together.

    Examples
    --------
    >>> schema = json_schema(FileKind.PROBLEM)
    >>> schema["properties"]["kind"]["enum"]
    ['motion', 'path', 'stroke', 'function', 'dwell']
    """
    tables = [ProblemFile] if file is FileKind.PROBLEM else list(dict.fromkeys(FILES.values()))
    places, made = _generated(tables)
    head = {"$schema": GenerateJsonSchema.schema_dialect, "title": f"Grashof {file} file"}
    if file is FileKind.PROBLEM:
        name = places[ProblemFile].rpartition("/")[2]
        return {**head, **made.pop(name), "$defs": made}
    return {**head, "oneOf": [{"$ref": place} for place in places.values()], "$defs": made}


def _generated(tables: Sequence[type[Table]]) -> tuple[dict[type[Table], str], dict[str, Any]]:
    """References to tables, and the definitions of these and of all tables inside."""
    places, whole = models_json_schema(
        [(table, "validation") for table in tables], schema_generator=_Generator
    )
    return {table: places[table, "validation"]["$ref"] for table in tables}, whole["$defs"]


class _Generator(GenerateJsonSchema):
    """Pydantic's own, with the meaning of the keys, for files that have no null."""

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def field_title_should_be_set(self, schema: Any) -> bool:  # noqa: ARG002
        return False

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        table, made = schema["cls"], super().model_schema(schema)
        made.pop("title", None)
        given = made["properties"]
        made["properties"] = {
            key.name: _property(table, key, given[key.name]) for key in described_keys(table)
        }
        made["description"] = summary(table)
        return {**made, **conditions(table)}

    def tagged_union_schema(self, schema: core_schema.TaggedUnionSchema) -> JsonSchemaValue:
        choices: list[CoreSchema] = list(schema["choices"].values())
        return {"anyOf": [self.generate_inner(each) for each in choices]}


def _property(table: type[Table], key: Key, known: Shape) -> Shape:
    """The schema of a key."""
    made = dict(shape_of(table, key.name, {name: x for name, x in known.items() if name != "description"}))
    if key.words:
        made = {"enum": list(key.words)}
    if kinds := kinds_of(table) if key.name == "mechanism" else []:
        made = {"enum": kinds}
    if made.get("type") == "number":
        low, high = key.bounds
        made |= {"minimum": low} if isfinite(low) else {}
        made |= {"maximum": high} if isfinite(high) else {}
    if isinstance(key.usual, (bool, int, float, str)):
        made["default"] = str(key.usual) if isinstance(key.usual, str) else key.usual
    unit = f" Unit: {key.unit}." if key.unit else ""
    return {**made, "description": f"{key.text}{unit}"}

"""The tables of TOML files: strict types, keys from value types, one line with the key path per error."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from inspect import Parameter, signature
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, Self, TypeAlias, TypeVar, get_args, get_origin, get_type_hints

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    ValidationError,
    ValidationInfo,
    WithJsonSchema,
    create_model,
    field_validator,
    model_validator,
)
from pydantic_core import ErrorDetails, PydanticCustomError

from grashof.problems.values.errors import ProblemError, listing, shown, shown_key
from grashof.problems.values.text import hint, plain_text

# Type of a validator's error; its message states the requirement on the value.
WRONG = "wrong"
# Tags distinguish the shapes of a value. They enter the location of an error and are left out of its path.
TABLE, LIST, WORD, NUMBER = "<table>", "<list>", "<word>", "<number>"
_WANTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a string",
    "bool_type": "true or false",
    "model_type": "a table",
    "list_type": "a list",
}


class Table(BaseModel):
    """A table of a file. Its value type is built once here, so that errors of it are reported, too."""

    # Deferred, so that the checks of a table are made once, as part of those of its file.
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, defer_build=True)
    # Whether a misplaced key may be reported as belonging to this table.
    suggested: ClassVar[bool] = True
    # Types whose docstrings describe keys, besides that of the table and of the value that it makes.
    described_by: ClassVar[tuple[type, ...]] = ()

    def value(self) -> object:
        """The value type that the table states."""
        return None

    @model_validator(mode="after")
    def _refuse_bad_values(self) -> Self:
        self.value()
        return self


AnyTable = TypeVar("AnyTable", bound=Table)


def stated(
    table: type[AnyTable],
    document: dict[str, Any],
    folder: Path | None = None,
) -> AnyTable:
    """A parsed file as its table; `ProblemError` has a line with the key path of each error.

    Names of other files are relative to the folder; without one they are refused.
    """
    try:
        unit = document.get("length_unit")
        return table.model_validate(document, context={"folder": folder, "length_unit": unit})
    except ValidationError as refused:
        errors = refused.errors(include_url=False)
    # A missing key comes last: most often it is in the file, misspelt, and that error is clearer.
    errors.sort(key=lambda error: error["type"] == "missing")
    tables = dict(tables_of(table))
    raise ProblemError("\n".join(dict.fromkeys(_described(error, tables) for error in errors)))


def tables_of(table: type[Table], path: str = "") -> Iterator[tuple[str, type[Table]]]:
    """All tables of a file by their key paths, with "[]" where there may be several; the file comes first."""
    yield path, table
    for key, field in table.model_fields.items():
        for ending, inner in _tables_in(field.annotation):
            yield from tables_of(inner, f"{path}.{key}{ending}".lstrip("."))


def _tables_in(annotation: Any) -> Iterator[tuple[str, type[Table]]]:
    """The types of tables that a type is made of, with "[]" for those of lists."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        yield "", annotation
    ending = "[]" if get_origin(annotation) is list else ""
    for part in get_args(annotation):
        yield from ((ending + inner, table) for inner, table in _tables_in(part))


def _plain(text: str, key: ValidationInfo) -> str:
    return plain_text(text, str(key.field_name))


# Text for headings, axes and files.
Text: TypeAlias = Annotated[str, AfterValidator(_plain)]


_MOST_ENTRIES = 20_000  # of any list, such as the corners of a drawing


def unless(accepted: Callable[[Any], bool], wanted: str) -> partial[Any]:
    """The check that refuses a value, and states the requirement, unless it is accepted."""
    return partial(_checked, accepted=accepted, wanted=wanted)


def _checked(value: Any, *, accepted: Callable[[Any], bool], wanted: str) -> Any:
    if not accepted(value):
        raise PydanticCustomError(WRONG, wanted)
    return value


def listed(wanted: str, most: int = _MOST_ENTRIES) -> BeforeValidator:
    """Validator that refuses values other than lists, and lists that are too long."""
    return BeforeValidator(partial(_listed, wanted=wanted, most=most))


def _listed(value: Any, *, wanted: str, most: int) -> Any:
    short = unless(lambda entries: len(entries) <= most, f"a list of at most {most} entries")
    return short(_checked(value, accepted=lambda given: isinstance(given, list), wanted=wanted))


def of_length(count: int, wanted: str) -> AfterValidator:
    """Validator of a list of `count` entries."""
    return AfterValidator(unless(lambda values: len(values) == count, wanted))


def numbers(count: int) -> dict[str, Any]:
    """The JSON Schema of a list of `count` numbers."""
    return {"type": "array", "items": {"type": "number"}, "minItems": count, "maxItems": count}


# For lists whose length the value types check: their JSON Schema has it, too.
TWO = WithJsonSchema(numbers(2))


def one_of(*words: str) -> AfterValidator:
    """Validator of a word: one of those given."""
    return AfterValidator(unless(words.__contains__, listing(words)))


def tag(value: object) -> str | None:
    """The tag of a value's shape."""
    shapes = (((dict, Table), TABLE), (list, LIST), (str, WORD), (bool, None), ((int, float), NUMBER))
    return next((name for types, name in shapes if isinstance(value, types)), None)


def either(wanted: str) -> Discriminator:
    """Distinguishes the shapes that a value may have, described by `wanted`, by the tags of its types."""
    return Discriminator(tag, custom_error_type=WRONG, custom_error_message=wanted)


def _described(error: ErrorDetails, tables: Mapping[str, type[Table]]) -> str:
    path, kind = _path(error["loc"]), error["type"]
    if kind == "extra_forbidden":
        return _unknown(error["loc"], tables)
    if kind == "missing":
        return f"{path} is missing"
    if kind == "value_error":
        lines = str(error["ctx"]["error"]).splitlines()
        return "\n".join(_placed(line, path) for line in lines)
    return f"{path} is {_given(error['input'])}; it must be {_WANTED.get(kind, error['msg'])}"


def _placed(line: str, path: str) -> str:
    """A line with the full key path: a value type names its key from the top of the file, or alone."""
    table, dot, key = path.rpartition(".")
    if line.startswith(path):
        return line
    named = tuple(key + after for after in ": [.")
    return f"{table}{dot}{line}" if line.startswith(named) else f"{path}.{line}"


def _unknown(location: tuple[int | str, ...], tables: Mapping[str, type[Table]]) -> str:
    path, table, key = _path(location), _path(location[:-1]), str(location[-1])
    keys = list(tables[re.sub(r"\[\d+\]", "[]", table)].model_fields)
    homes = (name for name, other in tables.items() if key in other.model_fields and other.suggested)
    where = next((f"{home}.{key}".lstrip(".").replace("[]", "") for home in homes), None)
    elsewhere = None if where is None else f"did you mean {where}?"
    if (several := tables.get(f"{table}[]")) is not None and key in several.model_fields:
        elsewhere = f"it goes into tables [[{table}]]"
    return f"{path} is unknown; " + hint(key, keys, elsewhere or f"the keys are {', '.join(keys)}")


def _path(location: tuple[int | str, ...]) -> str:
    path = ""
    for part in location:
        if isinstance(part, int):
            path += f"[{part}]"
        elif part not in (TABLE, LIST, WORD, NUMBER):
            key = shown_key(part)
            path += f".{key}" if path else key
    return path


def _given(value: object) -> str:
    if isinstance(value, dict):
        return "a table"
    return str(value).lower() if isinstance(value, bool) else shown(value)


# Every key is tried by itself, with nothing besides.
EACH: Mapping[str, Mapping[str, Any]] = MappingProxyType({"*": {}})


class SpecTable(Table):
    """A table whose keys are the arguments of a value type, or of its `from_degrees` where it has that."""

    spec: ClassVar[type]
    # Further keys needed to try each key by itself, "*" for all others; the rest is not tried.
    beside: ClassVar[Mapping[str, Mapping[str, Any]]] = {}

    @classmethod
    def make(cls, **given: Any) -> Any:
        """A value from some of the keys."""
        return getattr(cls.spec, "from_degrees", cls.spec)(**given)

    @classmethod
    def needed(cls, key: str, given: Any) -> Mapping[str, Any] | None:  # noqa: ARG003
        """Further keys needed to try a key by itself; None where it is not tried."""
        return cls.beside.get(key, cls.beside.get("*"))

    @classmethod
    def argument(cls, given: Any) -> Any:
        """The value of a key, as an argument."""
        return given

    @field_validator("*")
    @classmethod
    def _by_itself(cls, given: Any, key: ValidationInfo) -> Any:
        name = str(key.field_name)
        if given is not None and (others := cls.needed(name, given)) is not None:
            cls.make(**{**others, name: cls.argument(given)})
        return given

    def given(self) -> dict[str, Any]:
        """The keys that are given, as arguments."""
        return {key: self.argument(getattr(self, key)) for key in self.model_fields_set}

    def value(self) -> Any:
        """The value of the keys that are given."""
        return self.make(**self.given())


class NestedTable(SpecTable):
    """A table of numbers, lists and places, which become tuples."""

    @classmethod
    def argument(cls, given: Any) -> Any:
        """A table as its value, a list as a tuple of values."""
        if isinstance(given, Table):
            return given.value()
        return tuple(cls.argument(each) for each in given) if isinstance(given, list) else given


AnySpecTable = TypeVar("AnySpecTable", bound=SpecTable)
_AS_DECLARED = (bool, int, float, str, int | None, float | None, str | None)


def spec_table(
    spec: type,
    base: type[AnySpecTable],
    types: Mapping[str, Any] = {},
    names: Sequence[str] = (),
    doc: str | None = None,
) -> type[AnySpecTable]:
    """The table of a value type, its keys with the defaults of the arguments.

    Types are those of the arguments where they are plain, else as given, perhaps with a default of the file's
    own; any other key is checked by the value type. `names` are the keys, by default all arguments in
    order.
    """
    make = getattr(spec, "from_degrees", spec)
    arguments = signature(make).parameters
    hints = get_type_hints(make.__init__ if isinstance(make, type) else make)  # type: ignore[misc]
    keys: dict[str, Any] = {}
    for name in names or arguments:
        declared = hints.get(name)
        given = types.get(name, declared if declared in _AS_DECLARED else Any)
        if not isinstance(given, tuple):
            default = arguments[name].default
            optional = default is None and given is not Any
            given = (given | None if optional else given, ... if default is Parameter.empty else default)
        keys[name] = given
    own = base is NestedTable or base.__name__.startswith("_")  # a base class of several tables
    name = f"{spec.__name__.removesuffix('Spec')}Table" if own else base.__name__
    table = create_model(name, __base__=base, __doc__=doc, **keys)
    table.spec = spec
    return table


def keys_of(
    spec: type,
    types: Mapping[str, Any] = {},
    names: Sequence[str] = (),
) -> Callable[[type[AnySpecTable]], type[AnySpecTable]]:
    """Decorator of a table: the keys of `spec_table` besides its own docstring and methods."""
    return lambda table: spec_table(spec, table, types, names, table.__dict__.get("__doc__"))

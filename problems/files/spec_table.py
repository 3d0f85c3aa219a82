"""Tables whose keys are the arguments of a value type, made from its signature."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from inspect import Parameter, signature
from types import MappingProxyType
from typing import Any, ClassVar, TypeVar, get_type_hints

from pydantic import ValidationInfo, create_model, field_validator

from grashof.problems.files.tables import Table

# Every key is tried by itself, with nothing besides.
EACH: Mapping[str, Mapping[str, Any]] = MappingProxyType({"*": {}})


class SpecTable(Table):
    """A table whose keys are the arguments of a value type, or of its `from_degrees` where it has that."""

    spec: ClassVar[type]
    # What each key takes besides to be tried by itself, "*" for all others; the rest is not tried.
    beside: ClassVar[Mapping[str, Mapping[str, Any]]] = {}

    @classmethod
    def make(cls, **given: Any) -> Any:
        """A value from some of the keys."""
        return getattr(cls.spec, "from_degrees", cls.spec)(**given)

    @classmethod
    def needed(cls, key: str, given: Any) -> Mapping[str, Any] | None:  # noqa: ARG003
        """What a key takes besides to be tried by itself; None where it is not tried."""
        return cls.beside.get(key, cls.beside.get("*"))

    @classmethod
    def argument(cls, given: Any) -> Any:
        """What a key states, as an argument."""
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
    own; what has neither is left to the value type. `names` are the keys where they are not all arguments in
    their order.
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
    table = create_model(base.__name__, __base__=base, __doc__=doc, **keys)
    table.spec = spec
    return table


def keys_of(
    spec: type,
    types: Mapping[str, Any] = {},
    names: Sequence[str] = (),
) -> Callable[[type[AnySpecTable]], type[AnySpecTable]]:
    """Decorator of a table: the keys of `spec_table` besides its own docstring and methods."""
    return lambda table: spec_table(spec, table, types, names, table.__dict__.get("__doc__"))

"""TOML files read into checked models, with errors that name file, key and what would have fit."""

import difflib
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import pydantic
from pydantic_core import ErrorDetails

from twin.errors import ConfigError, UsageError
from twin.files.looked_at import look_at


class Table(pydantic.BaseModel):
    """A TOML table: unknown keys are errors, values do not change after reading."""

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


TableT = TypeVar("TableT", bound=Table)


Data = dict[str, Any]
"""A TOML file as it was read."""

DEEPEST = 20
"""Tables and lists within each other; our own files have half a dozen."""


def read_toml(path: Path, table: type[TableT]) -> TableT:
    """Read a TOML file into a table model.

    Args:
        table: The model that names its keys.

    Raises:
        ConfigError: The file is missing, is not TOML, or has a wrong key or value.
    """
    return checked(load_toml(path), table, str(path))


def checked(data: Data, table: type[TableT], where: str | Callable[[str], str | Path]) -> TableT:
    """Check content against a table model.

    Args:
        table: The model that names its keys.
        where: What a message begins with, such as the file; or a function that gives it for a key with dots.

    Raises:
        ConfigError: A wrong key or value.
    """

    def placed(key: str) -> str:
        return str(where if isinstance(where, str) else where(key))

    try:
        made = table.model_validate(data)
    except pydantic.ValidationError as error:
        lines = "\n".join(
            f"{placed(_key(detail))}: {_explain(detail, table)}" for detail in error.errors()
        )
        raise ConfigError(lines) from error
    if wrong := list(_of_another_type(data, made)):
        raise ConfigError("\n".join(f"{placed(key)}: '{key}': {fault}" for key, fault in wrong))
    return made


def _of_another_type(written: Any, made: Any, key: str = "") -> Iterator[tuple[str, str]]:
    """Keys whose values pydantic has made something else of, such as 1 of true and 5 of "5", and what is wrong."""
    if isinstance(made, bool):
        if not isinstance(written, bool):
            yield key, f"true or false, without quotes, is wanted here (got {written!r})"
    elif isinstance(made, int | float) and isinstance(written, str):
        yield key, f"a number is written without quotes: {written.strip()} (got {written!r})"
    elif isinstance(written, bool):
        if isinstance(made, int | float):
            yield key, f"a number is wanted here (got {str(written).lower()})"
    elif isinstance(written, dict):
        for name, value in written.items():
            inner = _made_of(made, name)
            yield from _of_another_type(value, inner, f"{key}.{name}" if key else str(name))
    elif isinstance(written, list | tuple) and isinstance(made, list | tuple):
        for index, (value, inner) in enumerate(zip(written, made, strict=False)):
            yield from _of_another_type(value, inner, f"{key}.{index}")


def _made_of(made: Any, name: str) -> Any:
    """What a key of a table has become; None where a validator has made something else of it."""
    if isinstance(made, Mapping):
        return made.get(int(name) if name.isdecimal() and name not in made else name)
    if not isinstance(made, pydantic.BaseModel):
        return None
    fields = type(made).model_fields.items()
    field = next((own for own, info in fields if name in (own, info.alias)), None)
    return None if field is None else getattr(made, field)


def load_toml(path: Path) -> Data:
    """Read a TOML file without checking its keys.

    Raises:
        ConfigError: The file is missing, is not TOML, or holds what no file here has a use for.
    """
    try:
        data = tomllib.loads(look_at(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: is not UTF-8 text") from error
    except RecursionError as error:
        raise ConfigError(f"{path}: {_TOO_DEEP}") from error
    except ValueError as error:  # more than TOMLDecodeError: a number of thousands of digits
        raise ConfigError(f"{path}: is not TOML: {error}") from error
    _refuse_oddities(data, path)
    return data


def _refuse_oddities(data: Data, path: Path) -> None:
    """Refuse texts that the system ends early (they may name files), and tables without end."""
    values, depth = list(data.values()), 1
    while values:
        if depth > DEEPEST:
            raise ConfigError(f"{path}: {_TOO_DEEP}")
        if any(isinstance(value, str) and "\0" in value for value in values):
            raise ConfigError(f"{path}: a text holds the character NUL")
        inner: list[Any] = []
        for value in values:
            if isinstance(value, dict):
                inner += value.values()
            elif isinstance(value, list):
                inner += value
        values, depth = inner, depth + 1


_TOO_DEEP = f"has tables or lists within each other, more than {DEEPEST} deep"


def _explain(detail: ErrorDetails, table: type[pydantic.BaseModel]) -> str:
    key = _key(detail) or "(file)"
    if detail["type"] == "missing":
        return f"'{key}' is missing"
    if detail["type"] == "tuple_type" and isinstance(detail["input"], dict):
        known = _known_keys(table, detail["loc"])
        if known:
            return _as_list_of_tables(key, detail["input"], known)
    if detail["type"] != "extra_forbidden":
        message = detail["msg"].removeprefix("Value error, ")
        whole_table = isinstance(detail["input"], dict)
        return f"'{key}': {message}" + ("" if whole_table else f" (got {detail['input']!r})")
    known = _known_keys(table, detail["loc"][:-1])
    nearest = difflib.get_close_matches(str(detail["loc"][-1]), known, n=1)
    hint = f"did you mean '{nearest[0]}'?" if nearest else f"known keys: {', '.join(sorted(known))}"
    return f"unknown key '{key}'; {hint}"


def _as_list_of_tables(key: str, written: Data, known: Sequence[str]) -> str:
    """What to write in place of a table, or of a table of tables by their numbers."""
    number = next((each for each in written if each.isdecimal()), None)
    said = f"'{key}' is a list of tables: write [[{key}]]"
    if number is None or "number" not in known:
        return f"{said} in place of [{key}]"
    return f"{said} and number = {int(number)} in place of [{key}.{number}]"


def _key(detail: ErrorDetails) -> str:
    return ".".join(str(part) for part in detail["loc"])


def _known_keys(model: Any, path: tuple[int | str, ...]) -> list[str]:
    for part in path:
        model = _inner_model(model, part)
        if model is None:
            return []
    return list(model.model_fields)


def _inner_model(model: type[pydantic.BaseModel], part: int | str) -> Any:
    """The table that ``part`` leads into; an index or a free key stays with its element's table."""
    if not isinstance(part, str) or part not in model.model_fields:
        return model
    return _first_model(model.model_fields[part].annotation)


def _first_model(annotation: Any) -> Any:
    if isinstance(annotation, type) and issubclass(annotation, pydantic.BaseModel):
        return annotation
    for argument in getattr(annotation, "__args__", ()):
        found = _first_model(argument)
        if found is not None:
            return found
    return None


def merged(
    above: Data, below: Data, replaces: Callable[[Data, Data], bool] = lambda _above, _below: False
) -> Data:
    """Two tables as one, key by key; any other value, lists included, is that of ``above``.

    Args:
        above: What comes first.
        below: What holds where ``above`` has no value.
        replaces: Whether an inner table of ``above`` is taken whole.
    """
    made = dict(below) | above
    for key in above.keys() & below.keys():
        first, second = above[key], below[key]
        if isinstance(first, dict) and isinstance(second, dict) and not replaces(first, second):
            made[key] = merged(first, second, replaces)
    return made


Change = tuple[str, Any]
"""A key of the job (``job.``) or machine file (``machine.``) with dots, and its value."""


def changed(data: dict[str, Any], prefix: str, changes: Sequence[Change]) -> dict[str, Any]:
    """Content of a TOML file with the changes of one prefix made; the rest is left to the others.

    Raises:
        UsageError: A change goes through something that is no table.
    """
    made = data
    for key, value in changes:
        kind, *parts = key.split(".")
        if kind == prefix:
            made = _with(made, parts, value, key)
    return made


def _with(
    table: Mapping[str, Any], parts: Sequence[str], value: object, key: str
) -> dict[str, Any]:
    name, *rest = parts
    if not rest:
        return {**table, name: value}
    below = table.get(name, {})
    if not isinstance(below, dict):
        raise UsageError(f"--vary {key}: '{name}' is no table")
    return {**table, name: _with(below, rest, value, key)}

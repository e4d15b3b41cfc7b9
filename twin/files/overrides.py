"""Values of a job or a machine file that are changed for one run, by their keys."""

from collections.abc import Mapping, Sequence
from typing import Any

from twin.errors import UsageError

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

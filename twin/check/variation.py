"""Runs of one job with values changed: ``machine.axes.X.kv=20,30,40``."""

import functools
import itertools
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from twin.check.task import JobVariant
from twin.errors import UsageError

MOST_VARIANTS = 10_000
"""Combinations that one sweep may have; more is a slip of the pen."""


def variants(path: Path, vary: Sequence[str]) -> list[JobVariant]:
    """Every combination of the values that are to be varied.

    Args:
        vary: ``KEY=VALUES`` each: values separated by commas, or ``FROM:TO:COUNT`` evenly spaced.

    Raises:
        UsageError: A text is none of these, or there are too many combinations.
    """
    return combinations(path, list(map(_axis, vary)))


def combinations(path: Path, vary: Sequence[tuple[str, Sequence[Any]]]) -> list[JobVariant]:
    """The same, of keys with their values.

    Raises:
        UsageError: A key occurs twice, is none of a job or machine, or has no values; or there are too many
            combinations.
    """
    for key, values in vary:
        if not values:
            raise UsageError(f"{key}: no values to vary it by")
        _require_key(key, key)
    axes = [[(key, value) for value in values] for key, values in vary]
    keys = [key for key, _ in vary]
    if len(set(keys)) < len(keys):
        raise UsageError(f"--vary: a key occurs twice: {', '.join(keys)}")
    count = functools.reduce(lambda product, axis: product * len(axis), axes, 1)
    if count > MOST_VARIANTS:
        raise UsageError(f"--vary: {count} combinations are more than {MOST_VARIANTS}")
    return [JobVariant(path, changes) for changes in itertools.product(*axes)]


def _axis(text: str) -> tuple[str, list[Any]]:
    key, equals, values = text.partition("=")
    _require_key(key.strip() if equals and values.strip() else "", text)
    return key.strip(), _values(values, text)


def _require_key(key: str, text: str) -> None:
    kind, *parts = key.split(".")
    if not (parts and all(parts) and kind in ("job", "machine")):
        raise UsageError(
            f"--vary {text}: write machine.KEY=VALUES or job.KEY=VALUES, "
            "such as machine.axes.X.kv=20,30,40 or job.default_feed=500:3000:6"
        )


def _values(values: str, text: str) -> list[Any]:
    if values.count(":") == 2 and "," not in values:
        try:
            first, last, count = (float(part) for part in values.split(":"))
        except ValueError as error:
            raise UsageError(f"--vary {text}: FROM:TO:COUNT must be numbers") from error
        if not (count == int(count) and 2 <= count <= MOST_VARIANTS):
            raise UsageError(f"--vary {text}: COUNT must be 2 or more")
        step = (last - first) / (count - 1)
        return [first + index * step for index in range(int(count))]
    return [_value(each.strip()) for each in values.split(",")]


def _value(text: str) -> object:
    """A TOML value; a bare word is a text."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text

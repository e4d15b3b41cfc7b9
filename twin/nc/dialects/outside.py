"""Dialects that other packages bring: entry points of the group ``twin.dialects``.

Each names a ``Dialect``; ``tests/nc/dialects/test_outside.py`` shows a package of twenty lines.
"""

from collections.abc import Container
from importlib.metadata import EntryPoint, entry_points

from twin.nc.control.dialect import Dialect

GROUP = "twin.dialects"


def dialects_from_outside(
    taken: Container[str],
) -> tuple[dict[str, Dialect], dict[str, str]]:
    """Load them; those of this package, which are ``taken``, none may replace.

    Returns:
        Those that could be loaded, by name, and why the others could not.
    """
    found: dict[str, Dialect] = {}
    failed: dict[str, str] = {}
    for point in entry_points(group=GROUP):
        reason = _load(point, taken, found)
        if reason:
            failed[point.name] = reason
    return found, failed


def _load(point: EntryPoint, taken: Container[str], found: dict[str, Dialect]) -> str:
    """Load one; why that fails, or nothing."""
    package = point.dist.name if point.dist is not None else point.value
    try:
        dialect = point.load()
    except Exception as error:  # noqa: BLE001 (a foreign package may raise anything)
        return f"{point.value} of {package} cannot be loaded: {type(error).__name__}: {error}"
    if not isinstance(dialect, Dialect):
        return f"{point.value} of {package} is a {type(dialect).__name__}, not a Dialect"
    if dialect.name != point.name:
        return f"{point.value} of {package} is called '{dialect.name}'"
    if point.name in taken or point.name in found:
        return f"{point.value} of {package} has the name of another dialect"
    found[point.name] = dialect
    return ""

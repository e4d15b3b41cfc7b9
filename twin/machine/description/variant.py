"""A machine file that only says what it changes: ``base = "mill4"``."""

from pathlib import Path

from twin.errors import ConfigError
from twin.files.shipped import machine_file
from twin.files.toml import Data, load_toml

_DEEPEST = 8
"""Machine files that may stand on each other; more is a circle."""


def on_base(data: Data, path: Path, depth: int = 0) -> Data:
    """Lay a machine file over the one that its key ``base`` names.

    Tables are merged key by key; every other value, arrays included, replaces that of the base.

    Args:
        data: The machine file as read.
        path: Where it lies; ``base`` is a shipped machine's name or a path beside it.
        depth: How many files already stand on this one.

    Returns:
        The whole machine file, without ``base``.

    Raises:
        ConfigError: The base is missing or no TOML, or the files stand on each other in a circle.
    """
    name = data.get("base")
    if name is None:
        return data
    if not isinstance(name, str):
        raise ConfigError(f"{path}: 'base' must be a machine's name or a path")
    if depth == _DEEPEST:
        raise ConfigError(f"{path}: 'base' leads in a circle")
    below = machine_file(name, beside=path.parent)
    base = on_base(load_toml(below), below, depth + 1)
    if isinstance(base.get("model"), str):
        base["model"] = str((below.parent / base["model"]).resolve())
    return _merged(base, {key: value for key, value in data.items() if key != "base"})


def _merged(base: Data, changes: Data) -> Data:
    merged = dict(base)
    for key, value in changes.items():
        below = merged.get(key)
        if isinstance(below, dict) and isinstance(value, dict):
            merged[key] = _merged(below, value)
        else:
            merged[key] = value
    return merged

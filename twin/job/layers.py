"""Settings that several jobs share: ``twin.toml`` of a folder tree, and files that a job extends.

What a job says itself comes first, then the file that it extends, then the ``twin.toml`` of its
folder, then those of the folders above. Tables are laid over each other key by key; a list, such as
the tools, is taken whole from whoever says it first, and so is a stock of another shape.
"""

import dataclasses
from pathlib import Path
from typing import Any

from twin.errors import ConfigError
from twin.files.shipped import is_shipped
from twin.files.toml import Data, load_toml

SHARED_NAME = "twin.toml"
EXTENDS = "extends"
_LONGEST_CHAIN = 10
_FILES = (("machine",), ("stock", "file"), ("nominal", "file"))
"""Keys whose values are paths, relative to the file that says them."""


@dataclasses.dataclass(frozen=True, slots=True)
class Layer:
    """What one file says.

    Attributes:
        path: The file.
        data: Its content, paths made whole.
    """

    path: Path
    data: Data


def shared_layers(folder: Path) -> list[Layer]:
    """The ``twin.toml`` of a folder and of those above it, the nearest first.

    What ships with the package is not touched by files of its surroundings.

    Raises:
        ConfigError: One of them cannot be read, or names a program.
    """
    if is_shipped(folder):
        return []
    found = []
    for place in (folder.resolve(), *folder.resolve().parents):
        if (place / SHARED_NAME).is_file():
            found += extended_layers(place / SHARED_NAME, load_toml(place / SHARED_NAME))
    for layer in found:
        _refuse_program(layer)
    return found


def extended_layers(path: Path, data: Data) -> list[Layer]:
    """A file and those that it extends, the file itself first.

    Args:
        path: The file.
        data: Its content.

    Raises:
        ConfigError: A file is missing or wrong, or they extend each other in a circle.
    """
    layers: list[Layer] = []
    while True:
        base = data.get(EXTENDS)
        own = {key: value for key, value in data.items() if key != EXTENDS}
        layers.append(Layer(path, _with_whole_paths(own, path.parent, first=not layers)))
        if len(layers) > 1:
            _refuse_program(layers[-1])
        if base is None:
            return layers
        if not isinstance(base, str):
            raise ConfigError(f"{path}: '{EXTENDS}' must be the name of a TOML file")
        if len(layers) == _LONGEST_CHAIN:
            raise ConfigError(f"{path}: more than {_LONGEST_CHAIN} files extend each other")
        path = path.parent / base
        data = load_toml(path)


def layers_of(path: Path, data: Data) -> list[Layer]:
    """A job and all that it takes settings from, the job itself first.

    Args:
        path: The job file.
        data: Its content.

    Raises:
        ConfigError: A file is missing or wrong.
    """
    return [*extended_layers(path, data), *shared_layers(path.parent)]


def laid_over(layers: list[Layer]) -> Data:
    """The content of all layers, the first over the others."""
    merged: Data = {}
    for layer in layers:
        merged = _over(merged, layer.data)
    return merged


def layer_of(layers: list[Layer], key: str) -> Path:
    """The file that a wrong key stands in; the first where none says it.

    Args:
        layers: As they were laid over each other.
        key: With dots.
    """
    for layer in layers:
        value: Any = layer.data
        for part in key.split("."):
            if isinstance(value, list) and part.isdigit():
                value = value[int(part)] if int(part) < len(value) else None
            else:
                value = value.get(part) if isinstance(value, dict) else None
        if value is not None:
            return layer.path
    return layers[0].path


def _over(first: Data, second: Data) -> Data:
    merged = dict(second) | first
    for key in first.keys() & second.keys():
        above, below = first[key], second[key]
        if (
            isinstance(above, dict)
            and isinstance(below, dict)
            and not _is_other_stock(above, below)
        ):
            merged[key] = _over(above, below)
    return merged


def _is_other_stock(above: Data, below: Data) -> bool:
    return "shape" in above and above["shape"] != below.get("shape")


def _with_whole_paths(data: Data, folder: Path, *, first: bool) -> Data:
    """Paths of shared files made whole; those of the job itself stay as they are written."""
    if first and data.get("program") is not None:
        return data
    made = dict(data)
    for *tables, key in _FILES:
        table = made
        for name in tables:
            inner = table.get(name)
            table[name] = dict(inner) if isinstance(inner, dict) else inner
            table = table[name] if isinstance(table[name], dict) else {}
        value = table.get(key)
        if isinstance(value, str) and (folder / value).exists():
            table[key] = str((folder / value).resolve())
    for name in [name for name, value in made.items() if value is None]:
        del made[name]
    return made


def _refuse_program(layer: Layer) -> None:
    if "program" in layer.data:
        raise ConfigError(
            f"{layer.path}: settings that jobs share name no 'program'; a job does, and extends them"
        )

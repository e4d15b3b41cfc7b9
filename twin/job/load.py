"""A path becomes a job: found, read with the files that it shares, merged and checked, each once.

What a job says itself comes first, then the file that it extends, then the ``twin.toml`` of its
folder, then those of the folders above. Tables are merged key by key; a list, such as the tools, is
taken whole from the first that has it, and so is a stock of another shape.
"""

import dataclasses
import os
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from twin.errors import ConfigError, UsageError
from twin.files.looked_at import look_at
from twin.files.shipped import is_shipped, shipped_program
from twin.files.toml import Change, Data, changed, checked, load_toml, merged
from twin.job.job_file import JobFile

SHARED_NAME = "twin.toml"
EXTENDS = "extends"
DEFAULT = "default"
"""Named as the source of a tolerance that no file sets."""
ASSUMED, VARIED = Path("assumed"), Path("--vary")
"""Layers of a job that are no files: what is assumed of a program without a job, and what a sweep changes."""
_LONGEST_CHAIN = 10
_FILES = (("machine",), ("stock", "file"), ("nominal", "file"))
"""Keys whose values are paths, relative to the file that sets them."""


@dataclasses.dataclass(frozen=True, slots=True)
class Layer:
    """One file's share of a job, or that of what is no file.

    Attributes:
        path: The file, or ``ASSUMED`` or ``VARIED``.
        data: Its content, paths made absolute.
    """

    path: Path
    data: Data


class Job:
    """A job that was read.

    Attributes:
        folder: What relative paths in it are relative to.
        file: Its checked content; the files of an STL stock, of a nominal part and of fixtures are
            absolute paths.
        path: The job file; None where a program has none.
        layers: The files that it was merged from, the first over the others; none where it was made in memory.
        tolerances_from: Which file sets each tolerance, ``default`` where none does, by its key.
    """

    def __init__(
        self, folder: Path, file: JobFile, path: Path | None = None, layers: Sequence[Layer] = ()
    ) -> None:
        self.folder = folder
        self.file = _with_absolute_paths(file, folder)
        self.program = folder / file.program
        self.path = path
        self.layers = tuple(layers)
        self.tolerances_from = _set_by(file, self._shown_source)

    def with_file(self, file: JobFile) -> "Job":
        """The same job with other content."""
        return Job(self.folder, file, self.path, self.layers)

    def _shown_source(self, key: str) -> str:
        """The file that sets a key, as seen from the job's folder."""
        if not self.layers:
            return "job"
        path = layer_of(self.layers, key)
        if path in (ASSUMED, VARIED):
            return str(path)
        return os.path.relpath(path.resolve(), self.folder.resolve())


def load_job(path: Path, changes: Sequence[Change] = ()) -> Job:
    """Read a job, or make the default job of an NC program.

    An NC program with a job file of the same stem beside it is run by that job.

    Args:
        path: A ``.toml`` job file, an NC program, or the name of a shipped program.
        changes: Values under ``job.`` to change.

    Raises:
        UsageError: There is no such file, or it is a folder.
        ConfigError: The job file is wrong, or its program does not exist.
    """
    path = _found(path)
    job_path: Path | None = path if path.suffix == ".toml" else path.with_suffix(".toml")
    data = None
    if job_path == path or look_at(job_path).is_file():
        data = load_toml(job_path)
    if data is None or not (job_path == path or _runs(job_path, data, path)):
        job_path, data = None, {"program": path.name}
    layers = _layers_of(job_path or path, data)
    if varied := changed({}, "job", changes):
        layers.insert(0, Layer(VARIED, varied))
    file = checked(_merged(layers), JobFile, partial(layer_of, layers))
    job = Job(path.parent, file, job_path, layers)
    if not look_at(job.program).is_file():
        raise ConfigError(f"{job.program}: no such NC program")
    return job


def layer_of(layers: Sequence[Layer], key: str) -> Path:
    """The file that sets a key; the first where none does.

    Args:
        layers: The first over the others.
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


def _found(path: Path) -> Path:
    """The file that a path, or the name of a shipped program, stands for."""
    if path.is_dir():
        raise UsageError(f"{path}: a folder; twin check runs the programs in a folder")
    if path.is_file():
        return path
    shipped = None if path.suffix else shipped_program(str(path))
    if shipped is None:
        raise UsageError(f"{path}: no such file")
    return shipped


def _runs(job: Path, data: Data, program: Path) -> bool:
    """Whether a job file runs a program; one that names none is a job with an error."""
    named = data.get("program", program.name)
    return isinstance(named, str) and (job.parent / named).resolve() == program.resolve()


def _with_absolute_paths(file: JobFile, folder: Path) -> JobFile:
    if file.stock is not None and file.stock.file is not None:
        whole = str(look_at(folder / file.stock.file).absolute())
        file = file.model_copy(update={"stock": file.stock.model_copy(update={"file": whole})})
    if file.nominal is not None:
        whole = str(look_at(folder / file.nominal.file).absolute())
        file = file.model_copy(update={"nominal": file.nominal.model_copy(update={"file": whole})})
    if file.fixtures:
        fixtures = tuple(fixture.in_folder(folder) for fixture in file.fixtures)
        file = file.model_copy(update={"fixtures": fixtures})
    return file


def _set_by(file: JobFile, source: Callable[[str], str]) -> dict[str, str]:
    """What sets each tolerance that holds, by its key."""
    given = file.tolerance.model_dump(exclude_unset=True, exclude_none=True)
    return {
        key: source(f"tolerance.{key}") if key in given else DEFAULT
        for key in {**given, "contour_um": 0}
    }


# --- layers


def _layers_of(path: Path, data: Data) -> list[Layer]:
    """A job and all that it takes settings from, the job itself first."""
    return [*_extended(path, data), *_shared(path.parent)]


def _shared(folder: Path) -> list[Layer]:
    """The ``twin.toml`` of a folder and of those above it, the nearest first.

    What ships with the package is not touched by files of its surroundings.
    """
    if is_shipped(folder):
        return []
    found: list[Layer] = []
    for place in (folder.resolve(), *folder.resolve().parents):
        shared = look_at(place / SHARED_NAME)
        if shared.is_file():
            found += _extended(shared, load_toml(shared))
    for layer in found:
        _refuse_program(layer)
    return found


def _extended(path: Path, data: Data) -> list[Layer]:
    """A file and those that it extends, the file itself first."""
    layers: list[Layer] = []
    while True:
        base = data.get(EXTENDS)
        own = {key: value for key, value in data.items() if key != EXTENDS}
        layers.append(Layer(path, _with_found_files(own, path.parent, first=not layers)))
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


def _merged(layers: Sequence[Layer]) -> Data:
    """The content of all layers, the first over the others."""
    made: Data = {}
    for layer in layers:
        made = merged(made, layer.data, _is_other_stock)
    return made


def _is_other_stock(above: Data, below: Data) -> bool:
    return "shape" in above and above["shape"] != below.get("shape")


def _with_found_files(data: Data, folder: Path, *, first: bool) -> Data:
    """Paths of shared files made absolute; those of the job itself stay as they are written."""
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
        if isinstance(value, str) and look_at(folder / value).exists():
            table[key] = str((folder / value).resolve())
    for name in [name for name, value in made.items() if value is None]:
        del made[name]
    return made


def _refuse_program(layer: Layer) -> None:
    if "program" in layer.data:
        raise ConfigError(
            f"{layer.path}: settings that jobs share name no 'program'; a job does, and extends them"
        )

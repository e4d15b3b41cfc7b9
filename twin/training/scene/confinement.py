"""What a scene names lies in its folder, or is shipped: nothing else is opened for it.

A scene comes from anybody, and what it names is shown to whoever looks on. Every file is looked at
before it is read, with links followed: the program and those that it may call, the stock, the
machine with all that it is based on, its model, and what that includes.
"""

from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from xml.etree import ElementTree as ET

from twin.errors import ConfigError
from twin.files.shipped import is_shipped, machine_file
from twin.files.toml import load_toml
from twin.job.job_file import JobFile
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.text.source import Source, read_source

MOST_FILES = 100
"""Of a machine: each may name others."""


def leaves_folder(name: str) -> bool:
    """Whether a path leads out of the folder that it is taken from, by what is written."""
    path = PurePosixPath(name)
    return path.is_absolute() or ".." in path.parts or "\\" in name


class Confinement:
    """The folder of a scene, and what may be opened for it."""

    def __init__(self, scene: Path) -> None:
        """Take the folder in which a scene's file lies."""
        self._scene = scene
        self._folder = scene.resolve().parent

    def require(self, job: JobFile) -> None:
        """Refuse a job that names anything outside.

        Raises:
            ConfigError: It does; the message names it.
            UsageError: There is no such machine.
        """
        program = self._folder / job.program
        self._require_inside(program)
        if program.is_file():
            self._require_calls_inside(program, job.dialect)
        if job.stock is not None and job.stock.file:
            self._require_inside(self._folder / job.stock.file)
        waiting = [machine_file(job.machine, beside=self._folder)]
        for _ in range(MOST_FILES):
            if not waiting:
                return
            path = waiting.pop()
            self._require_inside(path)
            if not is_shipped(path):
                waiting += _named_by_machine(path) if path.suffix == ".toml" else self._read(path)
        raise ConfigError(f"{self._scene}: its machine names more than {MOST_FILES} files")

    def _require_calls_inside(self, program: Path, named: str | None) -> None:
        """Refuse a program that calls a file outside, read by its dialect, or by any if none is named."""

        def look(called: Path, caller: Source, line: int) -> None:
            self._require_inside(called, f"{caller.name}: line {line} calls a file: ")

        for dialect in DIALECTS.values() if named is None else (dialect_named(named),):
            if dialect.library is not None:
                source = read_source(program, dialect)
                dialect.library(source, program.parent, dialect, look)

    def _require_inside(self, path: Path, why: str = "") -> None:
        if not path.resolve().is_relative_to(self._folder) and not is_shipped(path):
            raise ConfigError(f"{self._scene}: {why}'{path}' leads out of the scene's folder")

    def _read(self, model: Path) -> Iterator[Path]:
        """What an MJCF file names: others of its kind that it includes; the rest is only looked at."""
        try:
            elements = list(ET.fromstring(model.read_bytes()).iter())  # noqa: S314 (expat bounds entities)
        except (OSError, ET.ParseError) as error:
            raise ConfigError(f"{model}: is not an MJCF model: {error}") from error
        folders = [Path()]
        for element in elements:
            folders += [
                Path(value) for name, value in element.attrib.items() if name.endswith("dir")
            ]
        for element in elements:
            for name, value in element.attrib.items():
                if not name.startswith("file") and not name.endswith("dir"):
                    continue
                if leaves_folder(value):
                    raise ConfigError(f"{model}: '{value}' leads out of the scene's folder")
                for folder in folders:
                    self._require_inside(model.parent / folder / value)
                if element.tag in ("include", "model"):
                    yield model.parent / value


def _named_by_machine(path: Path) -> list[Path]:
    """The base and the model that a machine file names."""
    data = load_toml(path)
    base, model = data.get("base"), data.get("model")
    found = [machine_file(base, beside=path.parent)] if isinstance(base, str) else []
    return found + ([path.parent / model] if isinstance(model, str) else [])

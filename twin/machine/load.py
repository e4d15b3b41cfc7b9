"""A machine file becomes a machine: found, merged with the file that it is based on, checked, each once.

A machine file may say no more than what it changes: ``base = "mill4"``.
"""

from collections.abc import Sequence
from pathlib import Path

from twin.errors import ConfigError
from twin.files.looked_at import look_at
from twin.files.shipped import machine_file
from twin.files.toml import Change, Data, changed, checked, load_toml, merged
from twin.job.fixture import FixtureTable
from twin.job.load import Job
from twin.machine.description.config import MachineConfig
from twin.machine.description.machine_file import MachineFile


def load_machine(
    job: Job, name: str | None = None, changes: Sequence[Change] = ()
) -> MachineConfig:
    """The machine of a job, with what the job clamps on its table in addition to the stock.

    Args:
        name: Overrides the job's machine; a path is relative to the working folder.
        changes: Values under ``machine.`` to change.

    Raises:
        UsageError: There is no such machine.
        ConfigError: Its file or its model is missing or wrong, or a fixture has the name of another.
    """
    path = machine_file(job.file.machine, beside=job.folder) if name is None else machine_file(name)
    return read_machine(path, changes, job.file.fixtures)


def read_machine(
    path: Path, changes: Sequence[Change] = (), fixtures: Sequence[FixtureTable] = ()
) -> MachineConfig:
    """Read a machine file.

    Args:
        changes: Values under ``machine.`` to change.
        fixtures: Additional work holding on its table; their files are absolute paths.

    Raises:
        ConfigError: The file or the model that it names is missing or wrong, or a fixture has the name of
            another.
    """
    data = changed(_on_base(load_toml(path), path), "machine", changes)
    file = checked(data, MachineFile, str(path))
    if fixtures:
        file = file.model_copy(update={"fixtures": (*file.fixtures, *fixtures)})
        names = [fixture.name for fixture in file.fixtures]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ConfigError(f"fixture '{twice[0]}' is named twice")
    machine = MachineConfig(path, file)
    if not look_at(machine.model_path).is_file():
        raise ConfigError(f"{path}: model '{machine.file.model}' does not exist")
    return machine


_DEEPEST = 8
"""Machine files that may be based on each other; more is a circle."""


def _on_base(data: Data, path: Path, depth: int = 0) -> Data:
    """Lay a machine file over the one that its key ``base`` names.

    Tables are merged key by key; every other value, arrays included, replaces that of the base.

    Args:
        path: Where it lies; ``base`` is a shipped machine's name or a path beside it.
        depth: How many files are based on this one.

    Returns:
        The whole machine file, without ``base``.

    Raises:
        ConfigError: The base is missing or no TOML, or the files are based on each other in a circle.
    """
    name = data.get("base")
    if name is None:
        return data
    if not isinstance(name, str):
        raise ConfigError(f"{path}: 'base' must be a machine's name or a path")
    if depth == _DEEPEST:
        raise ConfigError(f"{path}: 'base' leads in a circle")
    below = machine_file(name, beside=path.parent)
    base = _on_base(load_toml(below), below, depth + 1)
    if isinstance(base.get("model"), str):
        base["model"] = str((below.parent / base["model"]).resolve())
    return merged({key: value for key, value in data.items() if key != "base"}, base)

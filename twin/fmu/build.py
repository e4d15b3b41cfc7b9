"""Writes the file of a unit: ``twin export --fmu MACHINE``."""

import re
import shutil
import tempfile
from pathlib import Path
from typing import Any

import pythonfmu3

from twin.errors import UsageError
from twin.files.atomic import complete_or_absent
from twin.files.shipped import is_shipped, machine_file
from twin.fmu.slave import MACHINE
from twin.machine.load import read_machine

fmi: Any = pythonfmu3
_SCRIPT = '''"""A machine of mill-twin; the interpreter that loads it needs the package."""

from pythonfmu3 import Fmi3Slave

from twin.fmu.slave import MachineSlave


class {name}(MachineSlave, Fmi3Slave):
    """One instance."""
'''
_MOST_BYTES = 64 * 2**20
"""Of a machine's folder: a unit is no place for more."""


def build_unit(machine: str, out: Path) -> None:
    """Write a unit for co-simulation.

    Args:
        machine: A shipped machine's name, or its file; the folder of another one goes into the unit.
        out: The file to be, ``.fmu``.

    Raises:
        UsageError: There is no such machine, or nothing can be built here.
        OSError: The file cannot be written.
        ConfigError: The machine is wrong.
    """
    if out.suffix != ".fmu":
        raise UsageError(f"{out}: a unit's file ends with .fmu")
    if not fmi.FmuBuilder.has_binary():
        raise UsageError(
            "pythonfmu3 has no library for this computer's kind: units are built on x86-64"
        )
    path = machine_file(machine)
    name = re.sub(r"\W", "_", read_machine(path).file.name)
    name = name if name[:1].isalpha() else f"machine_{name}"
    with tempfile.TemporaryDirectory() as folder:
        inside = Path(folder) / "unit"
        inside.mkdir()
        (inside / f"{name}.py").write_text(_SCRIPT.format(name=name), encoding="utf-8")
        files: list[Path] = []
        named = path.parent.name if path.stem == "machine" else f"{path.parent.name}/{path.stem}"
        if not is_shipped(path):
            files.append(_copied(path.parent, Path(folder) / "machine"))
            named = f"machine/{path.name}"
        (inside / MACHINE).write_text(f"{named}\n", encoding="utf-8")
        files.append(inside / MACHINE)
        built = fmi.FmuBuilder.build_FMU(
            inside / f"{name}.py", Path(folder) / "built", files,
            canHandleVariableCommunicationStepSize=False,
        )  # fmt: skip
        with complete_or_absent(out) as whole:
            shutil.copyfile(built, whole)


def _copied(folder: Path, where: Path) -> Path:
    """A copy of a machine's folder."""
    size = sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
    if size > _MOST_BYTES:
        raise UsageError(f"{folder}: holds {size >> 20} MiB; give the machine a folder of its own")
    shutil.copytree(folder, where)
    return where

"""LinuxCNC's configuration of a machine: INI, HAL, tools and offsets, from ``machine.toml``."""

import dataclasses
from pathlib import Path
from typing import Any

from twin.errors import ConfigError
from twin.files.atomic import write_text
from twin.job.job_file import JobFile, ToolTable
from twin.link.component import templates
from twin.link.packet import JOINTS
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import Axes, FloatArray

NO_LIMIT = 1e9
"""What is where a machine has no limit [mm or deg]."""
_NANOSECONDS = 1e9


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Settings:
    """What a configuration says in addition to the machine.

    Attributes:
        display: The command line of LinuxCNC's screen.
        programs: Folder in which LinuxCNC looks for programs and subprograms.
        opened: The program that its screen opens with; None: its own.
        following_error_limit: LinuxCNC's own limit [mm or deg]; None: the machine's.
        part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].
        job: Its tools go into the tool table.
    """

    display: str
    port: int
    programs: Path
    opened: Path | None
    following_error_limit: float | None
    part_zero: FloatArray
    job: JobFile


def write_configuration(folder: Path, machine: MachineConfig, settings: Settings) -> Path:
    """Write all that LinuxCNC reads.

    Args:
        machine: What it drives; the servo period is the machine's.

    Raises:
        ConfigError: LinuxCNC cannot drive this machine.
    """
    _require_axes(machine)
    spindle = machine.file.spindle
    content: dict[str, Any] = {
        "name": machine.file.name,
        "folder": folder,
        "display": settings.display,
        "port": settings.port,
        "programs": settings.programs,
        "opened": settings.opened,
        "period_ns": round(machine.file.servo_period_s * _NANOSECONDS),
        "axes": [_axis(machine, name, settings) for name in machine.axes.names],
        "coordinates": "".join(machine.axes.names),
        "path": machine.file.path,
        "spindle_acceleration": spindle.acceleration if spindle.waits else 0.0,
    }
    write_text(folder / "linuxcnc.var", offsets_text(machine.axes, settings.part_zero))
    write_text(folder / "linuxcnc.tbl", tools_text(settings.job))
    for suffix in ("ini", "hal"):
        text = templates().get_template(f"machine.{suffix}.j2").render(content)
        write_text(folder / f"linuxcnc.{suffix}", text)
    return folder / "linuxcnc.ini"


def _axis(machine: MachineConfig, name: str, settings: Settings) -> dict[str, Any]:
    axis = machine.axis(name)
    lowest, highest = axis.travel or (-NO_LIMIT, NO_LIMIT)
    limit = settings.following_error_limit or axis.following_error_limit or NO_LIMIT
    return {
        "name": name,
        "kind": "LINEAR" if axis.kind == "linear" else "ANGULAR",
        "velocity": axis.velocity,
        "acceleration": axis.acceleration,
        "lowest": lowest,
        "highest": highest,
        "following_error_limit": limit,
    }


def _require_axes(machine: MachineConfig) -> None:
    strange = [name for name in machine.axes.names if name not in LETTERS]
    if strange:
        raise ConfigError(f"LinuxCNC has no axis {strange[0]}: it has {', '.join(LETTERS)}")
    wrong = [
        name
        for name in machine.axes.names
        if (machine.axis(name).kind == "rotary") != (name in "ABC")
    ]
    if wrong:
        raise ConfigError(f"LinuxCNC takes A, B and C for rotary axes and no other: {wrong[0]}")
    if len(machine.axes) > JOINTS:
        raise ConfigError(f"LinuxCNC can be linked to {JOINTS} axes at most")


LETTERS = "XYZABCUVW"
"""The axes that LinuxCNC knows, in the order of its offsets."""
_FIRST_OFFSET = 5221
"""LinuxCNC's parameter of G54's first axis."""
_TOOLS = range(1, 100)
"""What a job that lists no tools has in its magazine, as in its own dialects."""


def offsets_text(axes: Axes, part_zero: FloatArray) -> str:
    """The parameter file, in which G54 is program zero.

    Args:
        part_zero: Machine coordinates of program zero, shape (k,), in LinuxCNC's units.
    """
    zero = axes.named(part_zero)
    rows = [
        f"{_FIRST_OFFSET + number}\t{zero.get(letter, 0.0):.9f}"
        for number, letter in enumerate(LETTERS)
    ]
    return "\n".join(["5220\t1", *rows]) + "\n"


def tools_text(job: JobFile, unit_mm: float = 1.0) -> str:
    """The tool table; lengths count against the job's first tool, as in the twin's dialects.

    Args:
        unit_mm: LinuxCNC's unit of length [mm].
    """
    tools = job.tools
    if "tools" not in job.model_fields_set:
        tools = tuple(ToolTable(number=number) for number in _TOOLS)
    return "".join(
        f"T{tool.number} P{tool.number} D{tool.diameter / unit_mm:.9f} "
        f"Z{(tool.length - tools[0].length) / unit_mm:.9f} ;{tool.kind}\n"
        for tool in tools
    )

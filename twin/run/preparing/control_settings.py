"""What a job and its machine tell the interpreter, and which of their keys a dialect does not read."""

import numpy as np

from twin.errors import ConfigError
from twin.job.job_file import JobFile
from twin.job.load import VARIED, Job, layer_of
from twin.machine.description.config import MachineConfig
from twin.nc.control.dialect import JobKey
from twin.nc.control.settings import Consulted, ControlSettings, MachineFunction, ToolData
from twin.nc.dialects import DIALECTS, Dialect
from twin.nc.path.tool_center.tool_center import PartOnMachine
from twin.run.preparing.layout import Layout, require_axes


def control_settings(
    job: Job, machine: MachineConfig, layout: Layout, *, strict: bool
) -> ControlSettings:
    """What the interpreter has to know of job and machine.

    Args:
        strict: Warnings of the interpreter are errors.

    Raises:
        ConfigError: The job names an axis that the machine lacks, or has.
    """
    control = machine.file.control
    for name, values in job.file.offsets.items():
        require_axes(values, machine, f"offsets.{name}")
    require_axes(job.file.written_zero, machine, "written_zero")
    return ControlSettings(
        axes=machine.axes,
        periodic=frozenset(name for name in machine.axes.names if machine.axis(name).periodic),
        axis_words=_axis_words(job, machine),
        default_feed=job.file.default_feed or control.default_feed,
        default_rotary_feed=job.file.default_rotary_feed or control.default_rotary_feed,
        start=machine.axes.named(layout.start),
        tools={
            tool.number: ToolData(tool.table_radius, tool.length, tool.name)
            for tool in job.file.tools
        },
        any_tool="tools" not in job.file.model_fields_set,
        offsets=Consulted(job.file.offsets),
        offset_rows=job.file.offset_rows,
        setup=_setup(job, machine, layout),
        machine_zero=_machine_zero(job, machine),
        written_zero=Consulted(job.file.written_zero) if job.file.written_zero else None,
        variables=Consulted(job.file.variables),
        m_functions={
            int(code[1:]): MachineFunction(declared.meaning, declared.dwell)
            for functions in (control.m_functions, job.file.m_functions)
            for code, declared in functions.items()
        },
        recalculate_on_rapid=control.recalculate_on_rapid,
        module_rotary=control.module_rotary,
        rollover=job.file.rollover or control.rollover,
        helical_feed=control.helical_feed,
        rotary_diameter=control.rotary_diameter,
        feed_of_all_axes=control.feed_of_all_axes,
        length_returns=control.length_returns,
        tool_change_height=_change_height(job, machine),
        block_skip=job.file.block_skip is True,
        block_skip_levels=_block_skip_levels(job.file),
        decimal_point=job.file.decimal_point or control.decimal_point,
        units=job.file.units or control.units,
        step_limit=job.file.step_limit,
        strict=strict,
    )


def refuse_taken_functions(job: Job, machine: MachineConfig, dialect: Dialect) -> None:
    """Refuse M codes of the machine's builder that control or machine act upon: the declaration would change nothing.

    Raises:
        ConfigError: There is one; the message names its file and key.
    """
    keys = [("control.m_functions", name) for name in machine.file.control.m_functions]
    keys += [("m_functions", name) for name in job.file.m_functions]
    for table, name in keys:
        meaning = dialect.codes.meaning_acted_upon(int(name[1:]))
        if meaning:
            key = f"{table}.{name}"
            place = (
                layer_of(job.layers, key) if table == "m_functions" and job.layers else machine.path
            )
            raise ConfigError(
                f"{place}: '{key}': {dialect.name} has {name} itself ({meaning}), and it stays that: "
                "leave it out, or declare the number that the machine's builder has chosen"
            )


def refuse_unread_keys(job: Job, dialect: Dialect) -> None:
    """Refuse keys of the job itself that its dialect passes over; a file that jobs of several dialects share may have them.

    Raises:
        ConfigError: There is one; the message names its file and key.
    """
    for key in sorted((set(JobKey) - dialect.job_keys) & job.file.model_fields_set):
        if says_itself(job, key):
            place = layer_of(job.layers, key) if job.layers else "job"
            readers = ", ".join(name for name, each in DIALECTS.items() if key in each.job_keys)
            raise ConfigError(
                f"{place}: '{key}': {dialect.name} has no such setting, only {readers}"
            )


def says_itself(job: Job, key: str) -> bool:
    """Whether the job, or the command line, sets a key, and not a file that several jobs share."""
    return not job.layers or layer_of(job.layers, key) in (VARIED, job.path)


def _setup(job: Job, machine: MachineConfig, layout: Layout) -> PartOnMachine | None:
    """The part on the machine; None where no axis turns."""
    if "rotary" not in machine.axes.kinds:
        return None
    travels = [machine.axis(name).travel or (-np.inf, np.inf) for name in machine.axes.names]
    return PartOnMachine(
        machine.kinematics, layout.part_zero, job.file.tools[0].length, np.array(travels)
    )


def _block_skip_levels(file: JobFile) -> frozenset[int]:
    """Numbers behind the slash of blocks that are left out."""
    return frozenset() if isinstance(file.block_skip, bool) else frozenset(file.block_skip)


def _change_height(job: Job, machine: MachineConfig) -> float | None:
    """Where Z goes before a tool changes; the job comes before the machine."""
    own = job.file.tool_change.height
    return machine.file.tool_change.height if own is None else own


IGNORED_AT_ZERO = "ignored at 0"
"""What ``[axes]`` of a job says of an axis whose words are passed over while they stay 0."""
_ROTARY_WORDS = "ABC"


def _axis_words(job: Job, machine: MachineConfig) -> dict[str, str | None]:
    """Words of axes that the machine lacks; those of a raw program's rotary axes are passed over at 0.

    Raises:
        ConfigError: One stands for an axis that the machine lacks, or it has that axis itself.
    """
    names = machine.axes.names
    if job.path is None and not job.file.axes:
        return dict.fromkeys(set(_ROTARY_WORDS) - set(names))
    for word, axis in job.file.axes.items():
        if word in names:
            raise ConfigError(f"job key 'axes.{word}': {machine.file.name} has an axis {word}")
        if axis != IGNORED_AT_ZERO and axis not in names:
            raise ConfigError(
                f"job key 'axes.{word}': '{axis}' is no axis of {machine.file.name} ({', '.join(names)}), "
                f'nor "{IGNORED_AT_ZERO}"'
            )
    return {w: None if axis == IGNORED_AT_ZERO else axis for w, axis in job.file.axes.items()}


def _machine_zero(job: Job, machine: MachineConfig) -> dict[str, float] | None:
    """Part coordinates of machine zero; None where the job leaves the height of part zero open."""
    if "Z" not in job.file.part_zero:
        return None
    zero = dict.fromkeys(machine.axes.names, 0.0)
    zero["X"], zero["Y"] = machine.part_frame.over_table
    zero |= job.file.part_zero
    return {name: -value for name, value in zero.items()}

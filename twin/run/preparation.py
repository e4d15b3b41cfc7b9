"""From a job to everything that a run needs: the program, its dialect, the machine, the places."""

import dataclasses
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pydantic

from twin.errors import ConfigError, RecordingError
from twin.files.toml import Change
from twin.job.job_file import JobFile
from twin.job.load import VARIED, Job, layer_of, load_job
from twin.machine.description.config import Machine
from twin.machine.load import load_machine
from twin.nc.control.settings import Consulted, ControlSettings, MachineFunction, ToolData
from twin.nc.dialects import DIALECTS, Dialect, dialect_named
from twin.nc.dialects.foreign import require_text
from twin.nc.functions import SpindleState
from twin.nc.interpreter import Interpretation
from twin.nc.path.tool_center import Setup
from twin.nc.text.diagnostics import ProgramError
from twin.nc.text.source import Source, read_source, source_from_text
from twin.recording.reader import RecordingHeader
from twin.run.layout import Layout, lay_out, require_axes
from twin.run.reading.assumed_machine import assumed_machine
from twin.run.reading.assumed_reading import (
    NOTHING_ASSUMED,
    UNKNOWN_FUNCTION,
    AssumedReading,
    assumed_reading,
    unknown_functions,
)
from twin.run.reading.dialect_choice import chosen_dialect


@dataclasses.dataclass(frozen=True, kw_only=True)
class Preparation:
    """A job made concrete.

    Attributes:
        job: The job file and where it lies.
        layout: Where the job lies on its machine.
        dialect: The language that the program is written in.
        settings: What the interpreter has to know of machine and job.
        dialect_reason: What showed the dialect of a program whose job names none; empty: the job does.
        reading: What was assumed of how a raw program is read.
        assumptions: All that was assumed of a raw program, its stock and tools too, a line each.
    """

    job: Job
    machine: Machine
    layout: Layout
    source: Source
    dialect: Dialect
    settings: ControlSettings
    dialect_reason: str = ""
    reading: AssumedReading = NOTHING_ASSUMED
    assumptions: tuple[str, ...] = ()

    def interpretation(self) -> Interpretation:
        """A fresh pass over the program."""
        return Interpretation(self.source, self.dialect, self.settings)

    @property
    def spindle(self) -> SpindleState:
        """The spindle before the program sets it, with the job's first tool."""
        return SpindleState(
            tool_speed=self.job.file.tools[0].speed,
            has_word=bool(self.dialect.words.spindle),
            fastest=self.machine.file.spindle.max_speed,
        )


def prepare(
    path: Path,
    *,
    dialect: str | None = None,
    machine: str | None = None,
    strict: bool = False,
    changes: Sequence[Change] = (),
    assuming: bool = False,
) -> Preparation:
    """Read a job, or a program with its job beside it, and all that it names.

    Args:
        dialect: Overrides the job's dialect.
        machine: Overrides the job's machine; a path is relative to the working folder.
        changes: Values of the job (``job.``) and the machine file (``machine.``) to change.
        assuming: How a program without a job is read may be assumed; the caller reports what was.

    Raises:
        UsageError: A file is missing or wrong, or the dialect cannot be recognised.
    """
    job, reading = load_job(path, changes), None
    if assuming and job.path is None:
        job, reading = _assumed(job, machine)

    def made_with(tools: Mapping[int, ToolData]) -> Preparation:
        return prepare_job(
            job, dialect=dialect, machine=machine, strict=strict, changes=changes, tools=tools
        )

    if reading is None:
        return made_with({})
    return _with_functions(*_with_radii(made_with, reading))


def _assumed(job: Job, machine: str | None) -> tuple[Job, AssumedReading]:
    """A raw program's job with what its text shows of machine and reading."""
    require_text(job.program)
    source = read_source(job.program)
    reading = assumed_reading(source)
    says_machine = machine is not None or "machine" in job.file.model_fields_set
    needed = None if says_machine else assumed_machine(source)
    if needed is not None:
        keys = {**reading.keys, "machine": needed[0]}
        reading = reading._replace(keys=keys, notes=(*reading.notes, needed[1]))
    return _with_keys(job, reading.keys), reading


_DOES_NOT_FIT = frozenset({"compensation-gouge", "compensation-radius"})
_WHOLE_RADIUS = (
    "radius compensation counts the whole radius: no comment says that D holds the wear alone "
    "(else radius_offset = 0.0 of its [[tools]])"
)
_RADIUS_IS_A_GUESS = (
    "no comment tells the tool's diameter: write the job by twin init, correct diameter of its [[tools]], "
    "or radius_offset = 0.0 where D holds the wear alone"
)
_COMPENSATES = re.compile(rb"G0*4[12](?![0-9])|[ \t]R[LR]\b", re.IGNORECASE)


def _with_radii(
    made_with: Callable[[Mapping[int, ToolData]], Preparation], reading: AssumedReading
) -> tuple[Preparation, AssumedReading]:
    """A raw program, whose tools have no radius in the control's table where their whole radius does not fit.

    Where it does not, and no radius does, the contours are the path of the tool's centre, and the table holds the wear.
    """
    try:
        made = made_with(reading.tools)
        if made.source.lines.any_holds(_COMPENSATES):
            _require_that_radii_fit(made)
            if any(tool.radius for tool in made.settings.tools.values()):
                reading = reading._replace(notes=(*reading.notes, _WHOLE_RADIUS))
    except ProgramError as error:
        finding = error.diagnostic
        if finding.code not in _DOES_NOT_FIT:
            raise
        if not reading.tools:
            hint = "; ".join(filter(None, (finding.hint, _RADIUS_IS_A_GUESS)))
            raise ProgramError(dataclasses.replace(finding, hint=hint)) from None
        tools = {n: dataclasses.replace(tool, radius=0.0) for n, tool in reading.tools.items()}
        worn = made_with(tools)
        _require_that_radii_fit(worn)
        note = (
            f"contours are the path of the tool's centre: in line {finding.line} {finding.message}"
        )
        return worn, reading._replace(tools=tools, notes=(*reading.notes, note))
    return made, reading


def _require_that_radii_fit(made: Preparation) -> None:
    """Raise the error of a compensated contour that leaves the tool no room; other errors are reported later."""
    try:
        for _ in made.interpretation().chunks():
            pass
    except ProgramError as error:
        if error.diagnostic.code in _DOES_NOT_FIT:
            raise


def _with_keys(job: Job, keys: Mapping[str, object]) -> Job:
    """A job with what was assumed, where it has no value of its own."""
    given = job.file.model_dump(exclude_unset=True)
    return job.with_file(JobFile.model_validate({**keys, **given}))


def _with_functions(made: Preparation, reading: AssumedReading) -> Preparation:
    """A raw program whose M codes that nobody knows do nothing."""
    reading = reading.as_read_by(made.dialect, made.settings)
    unknown = unknown_functions(made.source, made.dialect, frozenset(made.settings.m_functions))
    if not unknown:
        return dataclasses.replace(made, reading=reading)
    names = [f"M{number}" for number in unknown]
    declared = dict.fromkeys(names, UNKNOWN_FUNCTION)
    several = "do" if len(names) > 1 else "does"
    note = f"{', '.join(names)} {several} nothing: {made.dialect.name} has no such code"
    reading = AssumedReading({**reading.keys, "m_functions": declared}, (*reading.notes, note))
    given = made.job.file.model_dump(exclude_unset=True).get("m_functions", {})
    file = made.job.file.model_dump(exclude_unset=True) | {"m_functions": {**declared, **given}}
    job = made.job.with_file(JobFile.model_validate(file))
    functions_of_settings = dict.fromkeys(unknown, MachineFunction(UNKNOWN_FUNCTION))
    settings = dataclasses.replace(
        made.settings, m_functions={**made.settings.m_functions, **functions_of_settings}
    )
    return dataclasses.replace(made, job=job, settings=settings, reading=reading)


def prepare_job(
    job: Job,
    *,
    dialect: str | None = None,
    machine: str | None = None,
    strict: bool = False,
    changes: Sequence[Change] = (),
    tools: Mapping[int, ToolData] = MappingProxyType({}),
) -> Preparation:
    """Read all that a job names.

    Args:
        job: The job; other arguments and errors as for ``prepare``.
        dialect: As there.
        machine: As there.
        tools: What comments say of the tools of a job that names none.
    """
    twin_machine = load_machine(job, machine, changes)
    layout = lay_out(job.file, twin_machine)
    name = dialect or job.file.dialect
    named = None if name is None else dialect_named(name)
    settings = _control_settings(job, twin_machine, layout, strict=strict)
    if settings.any_tool and tools:
        settings = dataclasses.replace(settings, tools=tools)
    source, reason = read_source(job.program, named), ""
    if named is None:
        choice = chosen_dialect(job.program, settings, source)
        named, reason = choice.dialect, choice.reason
    language = named
    _refuse_taken_functions(job, twin_machine, language)
    _refuse_unread_keys(job, language)
    if language.library is not None:
        source = language.library(source, job.program.parent, language)
    return Preparation(
        job=job,
        machine=twin_machine,
        layout=layout,
        source=source,
        dialect=language,
        settings=settings,
        dialect_reason=reason,
    )


def anywhere(preparation: Preparation) -> Preparation:
    """The same program with some machine zero: what is cut does not depend on where that lies."""
    settings = preparation.settings
    if settings.machine_zero is None:
        zero = dict.fromkeys(preparation.machine.axes.names, 0.0)
        settings = dataclasses.replace(settings, machine_zero=zero)
    return dataclasses.replace(preparation, settings=settings)


def prepare_recorded(header: RecordingHeader, *, machine: str | None = None) -> Preparation:
    """What a recording was made with, from its header.

    Args:
        machine: Overrides the machine file; a path is relative to the working folder.

    Raises:
        UsageError: The recording does not hold its job, or the machine file is gone or wrong.
    """
    try:
        file = JobFile.model_validate_json(header.job)
    except pydantic.ValidationError as error:
        raise RecordingError(
            "the recording does not hold the job that it was made with: run the job again"
        ) from error
    recorded_on = header.machine_file if Path(header.machine_file).is_file() else header.machine
    job = Job(Path(), file)
    found = load_machine(job, machine or recorded_on)
    layout = lay_out(file, found)
    dialect = dialect_named(header.dialect)
    source = source_from_text(header.program_text, header.program)
    if not header.program_text:
        source = read_source(Path(header.program), dialect)
        if source.sha256 != header.program_sha256:
            raise RecordingError(f"{source.name}: is not the program that was recorded")
    return Preparation(
        job=job,
        machine=found,
        layout=layout,
        source=source,
        dialect=dialect,
        settings=_control_settings(job, found, layout, strict=False),
    )


def _control_settings(
    job: Job, machine: Machine, layout: Layout, *, strict: bool
) -> ControlSettings:
    control = machine.file.control
    for name, values in job.file.offsets.items():
        require_axes(values, machine, f"offsets.{name}")
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


def _refuse_taken_functions(job: Job, machine: Machine, dialect: Dialect) -> None:
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


_KEYS_OF_SOME = ("decimal_point", "offset_rows", "rollover")
"""Keys of a job that some dialects read, and the others pass over."""


def _refuse_unread_keys(job: Job, dialect: Dialect) -> None:
    """Refuse keys of the job itself that its dialect passes over; a file that jobs of several dialects share may have them.

    Raises:
        ConfigError: There is one; the message names its file and key.
    """
    for key in _KEYS_OF_SOME:
        if key not in job.file.model_fields_set or key in dialect.job_keys:
            continue
        if says_itself(job, key):
            place = layer_of(job.layers, key) if job.layers else "job"
            readers = ", ".join(name for name, each in DIALECTS.items() if key in each.job_keys)
            raise ConfigError(
                f"{place}: '{key}': {dialect.name} has no such setting, only {readers}"
            )


def says_itself(job: Job, key: str) -> bool:
    """Whether the job, or the command line, sets a key, and not a file that several jobs share."""
    return not job.layers or layer_of(job.layers, key) in (VARIED, job.path)


def _setup(job: Job, machine: Machine, layout: Layout) -> Setup | None:
    """The part on the machine; None where no axis turns."""
    if "rotary" not in machine.axes.kinds:
        return None
    travels = [machine.axis(name).travel or (-np.inf, np.inf) for name in machine.axes.names]
    return Setup(machine.kinematics, layout.part_zero, job.file.tools[0].length, np.array(travels))


def _block_skip_levels(file: JobFile) -> frozenset[int]:
    """Numbers behind the slash of blocks that are left out."""
    return frozenset() if isinstance(file.block_skip, bool) else frozenset(file.block_skip)


def _change_height(job: Job, machine: Machine) -> float | None:
    """Where Z goes before a tool changes; the job comes before the machine."""
    own = job.file.tool_change.height
    return machine.file.tool_change.height if own is None else own


IGNORED_AT_ZERO = "ignored at 0"
"""What ``[axes]`` of a job says of an axis whose words are passed over while they stay 0."""
_ROTARY_WORDS = "ABC"


def _axis_words(job: Job, machine: Machine) -> dict[str, str | None]:
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


def _machine_zero(job: Job, machine: Machine) -> dict[str, float] | None:
    """Part coordinates of machine zero; None where the job leaves the height of part zero open."""
    if "Z" not in job.file.part_zero:
        return None
    zero = dict.fromkeys(machine.axes.names, 0.0)
    zero["X"], zero["Y"] = machine.part_frame.over_table
    zero |= job.file.part_zero
    return {name: -value for name, value in zero.items()}

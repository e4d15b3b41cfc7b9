"""From a job to everything that a run needs: the program, its dialect, the machine, the places."""

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

import pydantic

from twin.errors import RecordingError
from twin.files.toml import Change
from twin.job.job_file import JobFile
from twin.job.load import Job, load_job
from twin.machine.description.config import MachineConfig
from twin.machine.load import load_machine
from twin.nc.control.settings import Consulted, ControlSettings, MachineFunction, ToolData
from twin.nc.dialects import Dialect, dialect_named
from twin.nc.dialects.foreign import require_text
from twin.nc.functions import SpindleState, acts
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import Source, read_source, source_from_text
from twin.recording.reader import RecordingHeader
from twin.run.preparing.control_settings import (
    control_settings,
    refuse_taken_functions,
    refuse_unread_keys,
)
from twin.run.preparing.layout import Layout, lay_out
from twin.run.reading.assumed_machine import assumed_machine
from twin.run.reading.assumed_offsets import notes_of_offsets, offsets_of_one_zero
from twin.run.reading.assumed_reading import (
    NOTHING_ASSUMED,
    UNKNOWN_FUNCTION,
    AssumedReading,
    assumed_reading,
    functions_of,
    unknown_functions,
)
from twin.run.reading.dialect_choice import chosen_dialect


@dataclasses.dataclass(frozen=True, kw_only=True)
class Preparation:
    """A job made concrete.

    Attributes:
        settings: What the interpreter has to know of machine and job.
        dialect_reason: What showed the dialect of a program whose job names none; empty: the job does.
        reading: What was assumed of how a raw program is read.
        assumptions: All that was assumed of a raw program, its stock and tools too, a line each.
    """

    job: Job
    machine: MachineConfig
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
        made = prepare_job(
            job, dialect=dialect, machine=machine, strict=strict, changes=changes, tools=tools
        )
        if reading is None or not made.settings.any_tool:
            return made
        settings = dataclasses.replace(made.settings, tool_of_call=reading.tool_of_call)
        return dataclasses.replace(made, settings=settings)

    if reading is None:
        return made_with({})
    return _with_offsets(_with_functions(*_with_radii(made_with, reading)))


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
    "radius compensation counts the whole radius: no comment says that D has only the wear "
    "(else radius_offset = 0.0 of its [[tools]])"
)
_RADIUS_IS_A_GUESS = (
    "no comment gives the tool's diameter: write the job with twin init, correct diameter of its [[tools]], "
    "or set radius_offset = 0.0 where D has only the wear"
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


def _with_offsets(made: Preparation) -> Preparation:
    """A raw program whose work offsets lie at program zero, where it feeds in one of them alone."""
    reading, given = made.reading, made.job.file.offsets
    if "offsets" not in reading.keys or given != reading.keys["offsets"]:
        return made
    names = offsets_of_one_zero(tuple(given), made.source, made.dialect, made.settings)
    offsets: dict[str, dict[str, float]] = {name: {} for name in names}
    file = made.job.file.model_dump(exclude_unset=True) | {"offsets": offsets}
    job = made.job.with_file(JobFile.model_validate(file))
    settings = dataclasses.replace(made.settings, offsets=Consulted(offsets))
    keys = {**reading.keys, "offsets": offsets}
    reading = reading._replace(keys=keys, notes=(*reading.notes, *notes_of_offsets(names)))
    return dataclasses.replace(made, job=job, settings=settings, reading=reading)


def _with_functions(made: Preparation, reading: AssumedReading) -> Preparation:
    """A raw program whose M codes that nobody knows do nothing."""
    reading = reading.as_read_by(made.dialect, made.settings)
    declared_functions = frozenset(made.settings.m_functions)
    unknown = unknown_functions(functions_of(made.source), made.dialect, declared_functions)
    if not unknown:
        return dataclasses.replace(made, reading=reading)
    meanings = {number: acts(number) or UNKNOWN_FUNCTION for number in unknown}
    declared = {f"M{number}": meaning for number, meaning in meanings.items()}
    notes = (*reading.notes, *_notes_of_unknown(declared, made.dialect.name))
    reading = AssumedReading({**reading.keys, "m_functions": declared}, notes)
    given = made.job.file.model_dump(exclude_unset=True).get("m_functions", {})
    file = made.job.file.model_dump(exclude_unset=True) | {"m_functions": {**declared, **given}}
    job = made.job.with_file(JobFile.model_validate(file))
    functions_of_settings = {number: MachineFunction(each) for number, each in meanings.items()}
    settings = dataclasses.replace(
        made.settings, m_functions={**made.settings.m_functions, **functions_of_settings}
    )
    return dataclasses.replace(made, job=job, settings=settings, reading=reading)


def _notes_of_unknown(meanings: Mapping[str, str], dialect: str) -> Iterator[str]:
    """What M codes that a dialect lacks are taken for: the machine acts upon some of them all the same."""
    idle = [name for name, meaning in meanings.items() if meaning == UNKNOWN_FUNCTION]
    if idle:
        several = "do" if len(idle) > 1 else "does"
        yield f"{', '.join(idle)} {several} nothing: {dialect} has no such code"
    for name, meaning in meanings.items():
        if name not in idle:
            yield f"{name} is the sender's or the builder's {meaning}: {dialect} has no such code"


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
    settings = control_settings(job, twin_machine, layout, strict=strict)
    if settings.any_tool and tools:
        settings = dataclasses.replace(settings, tools=tools)
    source, reason = read_source(job.program, named), ""
    if named is None:
        choice = chosen_dialect(job.program, settings, source)
        named, reason = choice.dialect, choice.reason
    language = named
    refuse_taken_functions(job, twin_machine, language)
    refuse_unread_keys(job, language)
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
        settings=control_settings(job, found, layout, strict=False),
    )

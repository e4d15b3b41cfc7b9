"""What an operator or a trainer can do, as plain data that is checked before it reaches a machine.

A session is nothing but its scene and the commands that were given at each tick of the servo clock:
a log of them is enough to live it again.
"""

import re
from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from twin.errors import UsageError
from twin.files.toml import Table
from twin.training.scene.scene_file import (
    FEED_OVERRIDES,
    RAPID_OVERRIDES,
    SPINDLE_OVERRIDES,
    FaultTable,
    Mode,
)

MOST = 10**9
"""Beyond what anything is numbered with."""

MOST_TOOL_NUMBER = 9999
"""Of a tool that is added at the panel."""

SPINDLE_SPEEDS = (1.0, 20000.0)
"""Ends of what the spindle turns [1/min]."""

AxisName = Annotated[str, Field(max_length=8)]

LONGEST_TEXT = 2000
"""Characters of a block, of a program's line, of an answer."""
LONGEST_PROGRAM = 60_000
"""Characters of a program that is loaded from the page."""
_NO_TEXT = re.compile(r"[^\S\t\n ]|[\x00-\x08\x0e-\x1f\x7f]")
"""What is in no line of a program."""


def _plain(text: str) -> str:
    """A text with one kind of line ends, and nothing in it that cannot be seen."""
    text = text.replace("\r\n", "\n").replace("\xa0", " ")
    found = _NO_TEXT.search(text)
    if found:
        raise ValueError(f"U+{ord(found[0]):04X} is no letter of a program")
    return text


ProgramText = Annotated[str, pydantic.AfterValidator(_plain)]


class SelectMode(Table):
    """Turn the mode switch."""

    do: Literal["mode"] = "mode"
    mode: Mode


class CycleStart(Table):
    """Start the program, the next block or the MDI block; or go on after a hold."""

    do: Literal["cycle_start"] = "cycle_start"


class FeedHold(Table):
    """Stop the axes on their path."""

    do: Literal["feed_hold"] = "feed_hold"


class Reset(Table):
    """Give up what runs, and clear the alarm whose cause is gone."""

    do: Literal["reset"] = "reset"


class EmergencyStop(Table):
    """Press the mushroom button, or turn it free."""

    do: Literal["emergency_stop"] = "emergency_stop"
    pressed: bool = True


class Override(Table):
    """Turn an override dial."""

    do: Literal["override"] = "override"
    dial: Literal["feed", "rapid", "spindle"] = "feed"
    percent: Annotated[int, Field(ge=FEED_OVERRIDES[0], le=FEED_OVERRIDES[1])]

    @pydantic.model_validator(mode="after")
    def _within_dial(self) -> "Override":
        if self.dial == "rapid" and self.percent > RAPID_OVERRIDES[1]:
            raise ValueError(f"the rapid override ends at {RAPID_OVERRIDES[1]} %")
        if self.dial == "spindle" and self.percent < SPINDLE_OVERRIDES[0]:
            raise ValueError(f"the spindle override begins at {SPINDLE_OVERRIDES[0]} %")
        return self


class Jog(Table):
    """Move one axis by hand."""

    do: Literal["jog"] = "jog"
    axis: AxisName
    direction: Literal[1, -1]
    step: Annotated[float, Field(gt=0, le=1000)] | None = None
    """How far [mm or deg]; none: until ``jog_stop``."""
    feed: Annotated[float, Field(gt=0, le=100000)] = 2000.0
    """[mm/min or deg/min]."""


class Handwheel(Table):
    """Turn the handwheel by clicks; the axis follows it."""

    do: Literal["handwheel"] = "handwheel"
    axis: AxisName
    clicks: Annotated[int, Field(ge=-100, le=100)]
    step: Annotated[float, Field(ge=0.001, le=1.0)]
    """What a click is worth [mm or deg]."""


class Reference(Table):
    """Drive the axes to the machine's reference point, Z first."""

    do: Literal["reference"] = "reference"


class ReturnToPath(Table):
    """Drive the axes, which were jogged during a hold, back to where the program was held."""

    do: Literal["return_to_path"] = "return_to_path"


class Search(Table):
    """Let the next start begin at a line: what is before it is only computed."""

    do: Literal["search"] = "search"
    line: Annotated[int, Field(ge=0, le=MOST)]
    """0: from the beginning after all."""


class Switch(Table):
    """Turn a switch that says how programs run."""

    do: Literal["switch"] = "switch"
    name: Literal["optional_stop", "block_skip", "dry_run"]
    on: bool


class JogStop(Table):
    """Let go of the jog button."""

    do: Literal["jog_stop"] = "jog_stop"


class Enter(Table):
    """Type a block into MDI."""

    do: Literal["mdi"] = "mdi"
    text: Annotated[ProgramText, Field(max_length=LONGEST_TEXT)]


class Edit(Table):
    """Write a line of the program again; several lines replace it by several, none deletes it."""

    do: Literal["edit"] = "edit"
    line: Annotated[int, Field(ge=1, le=MOST)]
    text: Annotated[ProgramText, Field(max_length=LONGEST_TEXT)] | None = None


class Load(Table):
    """Load another program, or the same as it was edited elsewhere."""

    do: Literal["load"] = "load"
    text: Annotated[ProgramText, Field(max_length=LONGEST_PROGRAM)]


class Undo(Table):
    """Take back the last change of the program."""

    do: Literal["undo"] = "undo"


class Reload(Table):
    """Load the program as the scene has it."""

    do: Literal["reload"] = "reload"


class Spindle(Table):
    """Stop the spindle by hand; or start it, while no program moves the axes."""

    do: Literal["spindle"] = "spindle"
    on: bool
    speed: Annotated[float, Field(ge=SPINDLE_SPEEDS[0], le=SPINDLE_SPEEDS[1])] | None = None
    """[1/min]; none: as it last turned."""
    counter_clockwise: bool = False
    """As M4 turns it."""


class Coolant(Table):
    """Open or close the coolant by hand."""

    do: Literal["coolant"] = "coolant"
    on: bool


class SetZero(Table):
    """Make the place where an axis is read a value: the part zero moves."""

    do: Literal["set_zero"] = "set_zero"
    axis: AxisName
    reading: Annotated[float, Field(ge=-10000, le=10000)] = 0.0


class ChangeTool(Table):
    """Put a tool into the spindle by hand, a new one for one that has lost its edge."""

    do: Literal["change_tool"] = "change_tool"
    number: Annotated[int, Field(ge=0, le=MOST)]


class NewBlank(Table):
    """Clamp a new blank in the place of the one on the table."""

    do: Literal["new_blank"] = "new_blank"


class SetOffset(Table):
    """Write the part zero of an axis into the table, machine coordinates; or a work offset of it."""

    do: Literal["set_offset"] = "set_offset"
    axis: AxisName
    value: Annotated[float, Field(ge=-10000, le=10000)]
    name: Annotated[str, Field(max_length=8)] | None = None
    """Which work offset, counted from part zero; none: part zero itself."""


class SetTool(Table):
    """Write a tool's length or radius into the tool table."""

    do: Literal["set_tool"] = "set_tool"
    number: Annotated[int, Field(ge=0, le=MOST)]
    length: Annotated[float, Field(gt=0, le=1000)] | None = None
    """[mm]"""
    radius: Annotated[float, Field(ge=0, le=500)] | None = None
    """[mm]"""


class AddTool(Table):
    """Put another tool into the magazine, with a row of its own in the tool table."""

    do: Literal["add_tool"] = "add_tool"
    number: Annotated[int, Field(ge=1, le=MOST_TOOL_NUMBER)]
    kind: Literal["flat", "ball", "drill", "chamfer"]
    """The shape of its end; a bull-nose cutter would need a corner as well."""
    diameter: Annotated[float, Field(ge=0.1, le=100)]
    """[mm]"""
    length: Annotated[float, Field(ge=20, le=300)]
    """From the spindle nose to the tip [mm]."""


class Sign(Table):
    """Say who is at the panel, for the score sheet."""

    do: Literal["sign"] = "sign"
    name: Annotated[str, Field(max_length=80)]


class AnswerQuestion(Table):
    """Answer a scene's question."""

    do: Literal["answer"] = "answer"
    task: Annotated[int, Field(ge=1, le=MOST)]
    """Number of the task that asks."""
    choice: Annotated[str, Field(max_length=LONGEST_TEXT)]


class Hint(Table):
    """Ask for the next hint; it costs points."""

    do: Literal["hint"] = "hint"


class Finish(Table):
    """Hand in: the tasks that hold to the end are judged."""

    do: Literal["finish"] = "finish"


class Inject(Table):
    """Trainer: break something."""

    do: Literal["inject"] = "inject"
    fault: FaultTable


class Repair(Table):
    """Trainer: take back every fault."""

    do: Literal["repair"] = "repair"


class Freeze(Table):
    """Trainer: let time stand still."""

    do: Literal["freeze"] = "freeze"


class Unfreeze(Table):
    """Trainer: let time go on."""

    do: Literal["go_on"] = "go_on"


class Rewind(Table):
    """Trainer: take the machine back; time stands still then."""

    do: Literal["rewind"] = "rewind"
    seconds: Annotated[float, Field(gt=0, le=1e6)]
    """How far, in machine time [s]."""


class StartReplay(Table):
    """Trainer: show the session again."""

    do: Literal["replay"] = "replay"


class EndReplay(Table):
    """Trainer: come back from a replay to the present."""

    do: Literal["end_replay"] = "end_replay"


SessionCommand = Freeze | Unfreeze | Rewind | StartReplay | EndReplay
"""What is done to the session's time and not to its machine."""

Command = (
    SelectMode | CycleStart | FeedHold | Reset | EmergencyStop | Override | Jog | JogStop
    | Handwheel | Reference | ReturnToPath | Search | Switch | Enter | Edit | Load | Undo | Reload
    | Spindle | Coolant | ChangeTool | NewBlank | SetZero | SetOffset | SetTool | AddTool | Sign | AnswerQuestion | Hint
    | Finish | Inject | Repair | SessionCommand
)  # fmt: skip

TRAINERS = (Inject, Repair, Freeze, Unfreeze, Rewind, StartReplay, EndReplay)
"""Commands that are a trainer's alone."""

WRONG = {
    "float_type": "here belongs a number",
    "int_type": "here belongs a number",
    "greater_than": "the value must be above {gt:g}",
    "greater_than_equal": "the value begins at {ge:g}",
    "less_than_equal": "the value ends at {le:g}",
    "string_too_long": "there is room for {max_length} characters",
    "too_long": "there is room for {max_length} characters",
}
"""What is wrong with a value that somebody typed, by pydantic's name of the kind of error."""

_ADAPTER: pydantic.TypeAdapter[Command] = pydantic.TypeAdapter(
    Annotated[Command, Field(discriminator="do")]
)


def command_from(data: Any) -> Command:
    """Check a command that came from outside.

    Args:
        data: A mapping with ``do`` and what belongs to it.

    Raises:
        UsageError: It is no command; the message says what is wrong with it.
    """
    try:
        return _ADAPTER.validate_python(data, strict=True)
    except pydantic.ValidationError as error:
        detail = error.errors()[0]
        if detail["type"].startswith("union_tag"):
            raise UsageError("no such command: do") from error
        if detail["type"] in WRONG:
            said = WRONG[detail["type"]].format(**detail.get("ctx", {}))
            raise UsageError(f"{detail['loc'][-1]}: {said}") from error
        where = ".".join(str(part) for part in detail["loc"])
        message = detail["msg"].removeprefix("Value error, ")
        raise UsageError(f"no such command: {where + ': ' if where else ''}{message}") from error


def command_data(command: Command) -> dict[str, Any]:
    """A command as plain data, with only what was given."""
    return {"do": command.do, **command.model_dump(exclude_unset=True, exclude={"do"})}

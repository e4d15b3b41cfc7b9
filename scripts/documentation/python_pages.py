"""Reference of Python and of the files that a run writes, from docstrings and declarations."""

import inspect
import re
from collections.abc import Callable
from typing import Any

import twin
from twin.recording.form import (
    COLUMNS,
    CONTOUR,
    JOINT_COLUMNS,
    LATER_ATTRIBUTES,
    STEPS,
    TEXT_ATTRIBUTES,
    RecordingHeader,
)

_SECTION = re.compile(r"^(Args|Returns|Raises|Yields|Example|Attributes):$")
_LEAD = (
    "`recording.h5` is plain HDF5: n samples at the servo period, axes in the order of the attribute `axes`. "
    "Sample i of every dataset belongs to the instant `time[i]`."
)
_MORE = (
    "How it is read while it grows, from MATLAB and from pandas: "
    "[what the verdict rests on](../packages/compare.md#the-recording)."
)
_MEANINGS = {
    "time": "end of the sample",
    "line": "source line of the program, 0 before the first",
    "move": "number of the move, from 0",
    "fraction": "share of that move's length",
    "setpoint/position": "commanded position, machine coordinates, continuous",
    "setpoint/velocity": "its rate",
    "setpoint/acceleration": "its rate",
    "joint/position": "simulated position, of the same instant",
    "joint/velocity": "its rate",
    "drive/force": "force or torque of the drive",
    CONTOUR: "distance from the commanded path, seen from the part",
}
_ATTRIBUTES = {
    "axes": "names of the axes, in the order of the columns",
    "kinds": "`linear` or `rotary`, one for each axis",
    "period_s": "time between samples [s]",
    "part_zero": "machine coordinates of program zero [mm or deg]",
    "table_axis": "the axis that turns the part; empty where none does",
    "table_center": "machine X and Y of its centre [mm]",
    "table_zero": "its angle at which the part stands as programmed [deg]",
    "geometry": "errors of the machine's geometry (ISO 230), as text; empty where it has none",
    "program": "the program's name",
    "program_sha256": "checksum of its text",
    "dialect": "its dialect",
    "machine": "name of the machine",
    "twin_version": "version of the twin",
    "mujoco_version": "version of MuJoCo",
    "job": "the job as JSON",
    "machine_file": "where the machine file lay",
    "alarms": "what the machine raised, as JSON: pairs of time [s] and text",
    "complete": "true where the run was written to its end",
}


def python_page() -> str:
    """The functions of the package, with their shapes and units."""
    sections = [
        "# Python",
        "The commands as functions, with plain NumPy columns. `help(twin.run)` shows the same.",
    ]
    for name in ("interpret", "plan", "run", "sweep", "compare"):
        function = getattr(twin, name)
        sections += [
            f"## `twin.{name}`",
            _signature(name, function),
            _docstring(inspect.getdoc(function) or ""),
        ]
    return "\n\n".join(sections) + "\n"


def _signature(name: str, function: Callable[..., Any]) -> str:
    """A function's head, a line for each of its arguments."""
    signature = inspect.signature(function)
    arguments = [str(each).replace("pathlib.", "") for each in signature.parameters.values()]
    first = next(
        (
            at
            for at, each in enumerate(signature.parameters.values())
            if each.kind is each.KEYWORD_ONLY
        ),
        len(arguments),
    )
    arguments.insert(first, "*") if first < len(arguments) else None
    result = inspect.formatannotation(signature.return_annotation).rpartition(".")[2]
    lines = "".join(f"    {argument},\n" for argument in arguments)
    return f"```python\ntwin.{name}(\n{lines}) -> {result}\n```"


def _docstring(text: str) -> str:
    """A docstring in Google's form as Markdown: parts in bold, names as lists, examples as code."""
    parts: list[str] = []
    section = ""
    for line in text.splitlines():
        found = _SECTION.match(line)
        if found:
            section = found[1]
            parts += ["", f"**{section}**", ""]
        elif section == "Example":
            parts.append(line)
        elif section in ("Args", "Raises", "Attributes") and (
            entry := re.match(r"    (\w+): (.*)", line)
        ):
            parts.append(f"- `{entry[1]}`: {entry[2]}")
        else:
            parts.append(
                line.strip()
                if not section
                else f"  {line.strip()}"
                if parts[-1].startswith(("-", "  "))
                else line.strip()
            )
    marked = "\n".join(parts).replace("``", "`")
    return re.sub(r"(?m)((?:^    .*\n?)+)", lambda code: _fenced(code[0]), marked)


def _fenced(code: str) -> str:
    lines = "\n".join(line[4:] for line in code.rstrip().splitlines())
    return f"```pycon\n{lines}\n```\n"


def recording_page() -> str:
    """Columns and attributes of a recording."""
    columns = {**COLUMNS, **JOINT_COLUMNS, CONTOUR: (CONTOUR, "um")}
    rows = []
    for path, (_, unit) in columns.items():
        shape = "(n, axes)" if "/" in path else "(n,)"
        step = f"{STEPS[path]:.2g}" if path in STEPS else "whole" if path != "time" else "exact"
        rows.append(f"| `{path}` | {shape} | {unit or '–'} | {step} | {_MEANINGS[path]} |")
    attributes = [f"| `{name}` | {meaning} |" for name, meaning in _ATTRIBUTES.items()]
    assert {*TEXT_ATTRIBUTES, *LATER_ATTRIBUTES} <= set(_ATTRIBUTES), RecordingHeader
    return (
        "\n\n".join(
            (
                "# Recording",
                _LEAD,
                "| dataset | shape | unit | kept to | meaning |\n|---|---|---|---|---|\n"
                + "\n".join(rows),
                f"`{CONTOUR}` is missing where nobody compared. A dataset has its unit as the attribute `unit`.",
                "## Attributes of the file",
                "| attribute | meaning |\n|---|---|\n" + "\n".join(attributes),
                _MORE,
            )
        )
        + "\n"
    )

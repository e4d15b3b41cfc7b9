"""Makes a scene of a room as it stands: program, position, tables, faults, and the part as it was cut."""

import contextlib
import json
import re
import unicodedata
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from twin.errors import TwinError, UsageError
from twin.files.atomic import write_text
from twin.training.room.room import Room
from twin.training.room.setup.workpiece import Workpiece
from twin.training.scene.scene_file import read_scene
from twin.training.scene.vocabulary import Language, vocabulary

SLACK = 0.03
"""Share by which the material that is cut off may differ from that of the teacher's part."""
PLACES, FLAT_CELLS, FLAT_MM = 6, 4, 0.01
"""Places of the part that are measured, each with so many equal cells around it, equal within so much."""
_FINISHED, _NO_ALARM = 6, 4
"""Points of the two tasks."""
_LONGEST_NAME = 40


class SceneText(NamedTuple):
    """A scene that is not written yet.

    Attributes:
        content: Of its file, but for the program's name.
    """

    content: dict[str, Any]
    program: str


def scene_of(room: Room, language: Language, title: str, story: str) -> SceneText:
    """A room as it stands, as a scene.

    Its tasks are to finish the program, and the part where one was cut, and to do it without an alarm; more can
    be written into the file.

    Args:
        story: What the operator reads first.

    Raises:
        UsageError: The room cannot be written down as a scene.
    """
    tables = room.setup.tables
    if not title.strip():
        raise UsageError("a scene needs a title")
    first = next(iter(tables.tools))
    if tables.spindle != first:
        raise UsageError(f"put tool {first} into the spindle: scenes begin with it")
    words = vocabulary(language).labels
    content: dict[str, Any] = {
        "schema": 1,
        "language": language,
        "title": {language: title.strip()},
        "story": {language: story.strip() or title.strip()},
        "job": _job(room),
        "start": _start(room),
        "faults": [
            fault.model_dump(mode="json", exclude_unset=True) for fault in room.faults.active
        ],
        "tasks": [
            {"text": {language: words["task_finished"]}, "points": _FINISHED, "finished": True},
            {"text": {language: words["task_no_alarm"]}, "points": _NO_ALARM, "no_alarm": ["any"]},
        ],
    }
    if room.setup.work is not None and room.setup.work.removed > 0.0:
        content["part"] = _part(room.setup.work)
    return SceneText(content, "\n".join(room.program.lines) + "\n")


def write_scene(scene: SceneText, folder: Path) -> Path:
    """Write a scene and its program, under a name after its title that nothing has there.

    Raises:
        UsageError: It cannot be written, or is none that is on its own; nothing is left of it.
    """
    (title,) = scene.content["title"].values()
    name = _free_name(folder, title)
    path, program = folder / f"{name}.toml", folder / f"{name}.nc"
    content = scene.content | {"job": scene.content["job"] | {"program": program.name}}
    try:
        folder.mkdir(parents=True, exist_ok=True)
        write_text(program, scene.program)
        write_text(path, "".join(f"{key} = {_toml(value)}\n" for key, value in content.items()))
        read_scene(path)
    except (OSError, TwinError) as error:
        for written in (path, program):
            with contextlib.suppress(OSError):
                written.unlink()
        raise UsageError(f"this room is not a complete scene by itself: {error}") from error
    return path


def _job(room: Room) -> dict[str, Any]:
    """The scene's job, with the tools that have been added at the panel."""
    job, tools = room.scene.file.job, room.setup.tables.tools
    content = job.model_dump(mode="json", exclude_unset=True)
    if len(tools) > len(job.tools):
        content["tools"] = [
            tool.model_dump(mode="json", exclude_unset=True) for tool in tools.values()
        ]
    return content


def _start(room: Room) -> dict[str, Any]:
    """How the machine and its control stand."""
    names, tables = room.machine.machine.axes.names, room.setup.tables
    off = tables.zero - tables.true_zero
    length_difference = tables.lengths[tables.spindle] - tables.tool.length
    start: dict[str, Any] = {
        "mode": room.panel.mode,
        "position": {
            name: round(float(value), 3)
            for name, value in zip(names, room.standing_setpoint, strict=True)
        },
        "zero_error": {
            name: round(float(value), 4) for name, value in zip(names, off, strict=True) if value
        },
        "tool_length_error": round(length_difference, 4),
        "feed_override": room.panel.feed_override,
        "rapid_override": room.panel.rapid_override,
    }
    if room.auxiliaries.spindle.speed is not None:
        start["speed"] = room.auxiliaries.spindle.speed
    return start


def _part(work: Workpiece) -> dict[str, Any]:
    """What the part on the table is known by: its volume, and places in the middle of what is flat."""
    removed = [round(work.removed * (1.0 - SLACK), 1), round(work.removed * (1.0 + SLACK), 1)]
    stock = work.map
    if stock is None:
        return {"removed_mm3": removed}
    rows, columns = np.nonzero(stock.machined() & (stock.heights > stock.bottom))
    chosen: list[list[float]] = []
    for number in np.random.default_rng(0).permutation(len(rows)):
        row, column = int(rows[number]), int(columns[number])
        around = stock.heights[
            max(0, row - FLAT_CELLS) : row + FLAT_CELLS + 1,
            max(0, column - FLAT_CELLS) : column + FLAT_CELLS + 1,
        ]
        if around.size == (2 * FLAT_CELLS + 1) ** 2 and np.ptp(around) < FLAT_MM:
            x, y = work.program_place(row, column)
            chosen.append([round(x, 2), round(y, 2), round(work.measured(x, y, 0.0), 3)])
        if len(chosen) == PLACES:
            break
    return {"removed_mm3": removed, "points": chosen}


def _free_name(folder: Path, title: str) -> str:
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode().lower()
    stem = re.sub(r"[^a-z0-9]+", "_", plain).strip("_")[:_LONGEST_NAME] or "scene"
    number = 1
    while (folder / f"{(name := stem if number == 1 else f'{stem}_{number}')}.toml").exists():
        number += 1
    return name


def _toml(value: Any) -> str:
    """A value as TOML, tables within one line."""
    if isinstance(value, dict):
        return f"{{ {', '.join(f'{json.dumps(key)} = {_toml(each)}' for key, each in value.items())} }}"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    return json.dumps(value)

"""The table of the training page: every function that it names is on the panel, under that name."""

from pathlib import Path
from typing import NamedTuple

import pydantic
import pytest

from twin.training.scene.vocabulary import vocabulary
from twin.training.session import commands

ROOM = Path(commands.__file__).parents[1]
PAGE = {path.name: path.read_text("utf-8") for path in (ROOM / "page").glob("*.js")}


class Keys(NamedTuple):
    """Where a function is on the panel.

    Attributes:
        places: Labels of the sheets or groups of keys that the table names.
        labels: Those of its keys and fields.
        does: The commands that it gives.
    """

    places: tuple[str, ...]
    labels: tuple[str, ...]
    does: tuple[str, ...]


PANEL = {
    "start, hold, reset": Keys(
        ("cycle",), ("cycle_start", "feed_hold", "reset"), ("cycle_start", "feed_hold", "reset")
    ),
    "single block": Keys(("mode",), ("mode_single",), ("mode",)),
    "optional stop": Keys(("run",), ("optional_stop",), ("switch",)),
    "block skip": Keys(("run",), ("block_skip",), ("switch",)),
    "dry run": Keys(("run",), ("dry_run",), ("switch",)),
    "path preview": Keys((), ("preview",), ()),
    "start in mid-program": Keys(("run",), ("search",), ("search",)),
    "jog during a hold or at M0, back to the path": Keys(
        ("mode_jog", "manual"), ("return_to_path",), ("jog", "return_to_path")
    ),
    "jog, incremental jog": Keys(("jog",), ("continuous",), ("jog", "jog_stop")),
    "jog feed, rapid jog": Keys(("manual",), ("jog_feed", "jog_rapid"), ("jog",)),
    "handwheel": Keys(("manual",), ("handwheel",), ("handwheel",)),
    "reference return": Keys(("manual",), ("reference",), ("reference",)),
    "S, direction": Keys(
        ("manual",), ("spindle_speed", "clockwise", "counter_clockwise"), ("spindle",)
    ),
    "feed, rapid, spindle override": Keys(
        ("manual",), ("feed_override", "rapid_override", "spindle_override"), ("override",)
    ),
    "tool change by hand, a new one for a broken one": Keys(
        ("tools",), ("change_tool",), ("change_tool",)
    ),
    "MDI with its modal state": Keys(("mode",), ("mode_mdi",), ("mdi",)),
    "work offsets G54 to G59": Keys(("offsets",), ("value",), ("set_offset",)),
    "tool lengths and radii": Keys(("tools",), ("length", "radius"), ("set_tool",)),
    "touch off": Keys(("offsets", "tools"), ("preset", "touch_off"), ("set_zero", "set_tool")),
    "edit, undo, reload": Keys(("program", "run"), ("edit", "undo", "reload"), ("edit", "undo")),
    "alarm history": Keys(("history",), ("no_alarms",), ()),
    "new blank": Keys(("manual",), ("new_blank",), ("new_blank",)),
}


COMPOSED = {
    **dict.fromkeys(("mode_single", "mode_mdi"), "mode_${mode}"),
    **dict.fromkeys(("feed_override", "rapid_override"), "${name}_override"),
}
"""Labels that the page puts together."""


def table() -> dict[str, list[str]]:
    """Rows of the table by function: where it is here, and at four other panels."""
    page = (ROOM / "README.md").read_text("utf-8")
    lines = page.split("| function | here |")[1].split("\n\n")[0].splitlines()[2:]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    return {name: cells for name, *cells in rows}


def test_the_table_names_what_the_panel_has() -> None:
    assert list(table()) == list(PANEL)
    assert all(len(cells) == 5 and all(cells) for cells in table().values())


@pytest.mark.parametrize("function", PANEL)
def test_a_function_is_on_the_panel_under_its_name(function: str) -> None:
    keys, labels, pages = PANEL[function], vocabulary("en").labels, "".join(PAGE.values())
    here = table()[function][0].lower()
    for place in keys.places:
        assert labels[place].lower() in here, f"{here} does not name {labels[place]}"
    for label in (*keys.places, *keys.labels):
        assert labels[label].strip()
    for label in keys.labels:
        assert COMPOSED.get(label, label) in pages, f"no page says {label}"
    for command in keys.does:
        assert command in pages, f"no page gives {command}"
        adapter: pydantic.TypeAdapter[commands.Command] = pydantic.TypeAdapter(commands.Command)
        said = str(adapter.json_schema())
        assert f"'{command}'" in said

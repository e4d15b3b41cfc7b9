"""What the agent says about a machine: components and data items after MTConnect Part 2."""

import dataclasses
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Literal

from twin.nc.canonical import Axes
from twin.serve.motions import AxisMotion

Category = Literal["SAMPLE", "EVENT", "CONDITION"]
UNAVAILABLE = "UNAVAILABLE"
DOOR_CLOSED = "CLOSED"
"""``DOOR_STATE`` of a machine without a door."""


@dataclasses.dataclass(frozen=True, slots=True)
class DataItem:
    """One thing that is observed.

    Attributes:
        category: Samples are measured, events change in steps, conditions report health.
        type: In the words of the standard, such as ``PATH_FEEDRATE``.
        units: Of a sample; empty for others.
        sub_type: ``ACTUAL`` or ``COMMANDED``, where the type has such.
    """

    id: str
    category: Category
    type: str
    units: str = ""
    sub_type: str = ""

    @property
    def element(self) -> str:
        """Name of its observations' elements: the type in Pascal case."""
        return "".join(word.capitalize() for word in self.type.split("_"))


@dataclasses.dataclass(frozen=True, slots=True)
class Component:
    """A part of the machine.

    Attributes:
        element: In the words of the standard, such as ``Linear``.
        motion: How it moves; None: it is no axis of the machine, or nobody has said.
    """

    element: str
    id: str
    name: str
    items: tuple[DataItem, ...] = ()
    components: tuple["Component", ...] = ()
    motion: AxisMotion | None = None

    def walk(self) -> Iterator["Component"]:
        """This component and all that it consists of, outermost first."""
        yield self
        for component in self.components:
            yield from component.walk()


def device_of(
    name: str, axes: Axes, motions: Mapping[str, AxisMotion] = MappingProxyType({})
) -> Component:
    """The device that a machine is to a monitor.

    Identifiers begin with what they are about: ``X_position``, ``X_position_commanded``, ``X_load``,
    ``path_feedrate``, ``system``. The twin has no door: what observes a machine says ``DOOR_CLOSED``, since a
    program only runs behind a closed one.

    Args:
        motions: How they move, by their names.
    """
    kinds = zip(axes.names, axes.kinds, strict=True)
    moved = tuple(_axis(name, kind, motions.get(name)) for name, kind in kinds)
    spindle = Component(
        "Rotary",
        "S",
        "S",
        (
            DataItem("spindle_speed", "SAMPLE", "ROTARY_VELOCITY", "REVOLUTION/MINUTE", "ACTUAL"),
            DataItem("spindle_override", "EVENT", "ROTARY_VELOCITY_OVERRIDE"),
            DataItem("spindle_load", "SAMPLE", "LOAD", "PERCENT"),
        ),
    )
    path = Component(
        "Path",
        "path",
        "path",
        (
            DataItem("path_feedrate", "SAMPLE", "PATH_FEEDRATE", "MILLIMETER/SECOND", "ACTUAL"),
            DataItem("block", "EVENT", "BLOCK"),
            DataItem("execution", "EVENT", "EXECUTION"),
            DataItem("feed_override", "EVENT", "PATH_FEEDRATE_OVERRIDE", sub_type="PROGRAMMED"),
            DataItem("rapid_override", "EVENT", "PATH_FEEDRATE_OVERRIDE", sub_type="RAPID"),
            DataItem("line", "EVENT", "LINE_NUMBER", sub_type="ABSOLUTE"),
            DataItem("mode", "EVENT", "CONTROLLER_MODE"),
            DataItem("part_count", "EVENT", "PART_COUNT", sub_type="ALL"),
            DataItem("program", "EVENT", "PROGRAM"),
            DataItem("tool_number", "EVENT", "TOOL_NUMBER"),
        ),
    )
    controller = Component(
        "Controller",
        "controller",
        "controller",
        (
            DataItem("emergency_stop", "EVENT", "EMERGENCY_STOP"),
            DataItem("system", "CONDITION", "SYSTEM"),
        ),
        (path,),
    )
    coolant = Component(
        "Coolant", "coolant", "coolant", (DataItem("coolant_state", "EVENT", "ACTUATOR_STATE"),)
    )
    return Component(
        "Device",
        "device",
        name,
        (
            DataItem("availability", "EVENT", "AVAILABILITY"),
            DataItem("asset_changed", "EVENT", "ASSET_CHANGED"),
            DataItem("asset_removed", "EVENT", "ASSET_REMOVED"),
        ),
        (
            Component("Axes", "axes", "base", (), (*moved, spindle)),
            controller,
            Component("Systems", "systems", "systems", (), (coolant,)),
            Component("Door", "door", "door", (DataItem("door_state", "EVENT", "DOOR_STATE"),)),
        ),
    )


def _axis(name: str, kind: str, motion: AxisMotion | None) -> Component:
    linear = kind == "linear"
    what, units = ("POSITION", "MILLIMETER") if linear else ("ANGLE", "DEGREE")
    return Component(
        "Linear" if linear else "Rotary",
        name,
        name,
        (
            DataItem(f"{name}_position", "SAMPLE", what, units, "ACTUAL"),
            DataItem(f"{name}_position_commanded", "SAMPLE", what, units, "COMMANDED"),
            DataItem(f"{name}_load", "SAMPLE", "LOAD", "PERCENT"),
        ),
        motion=motion,
    )

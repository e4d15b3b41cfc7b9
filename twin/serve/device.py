"""What the agent says about a machine: components and data items after MTConnect Part 2."""

import dataclasses
from collections.abc import Collection, Iterator, Mapping
from types import MappingProxyType
from typing import Literal

from twin.kinematics import Kinematics
from twin.nc.canonical import Axes, FloatArray

_DIGITS = 6
"""Decimals of directions and places; more is rounding of the model's own turns."""


@dataclasses.dataclass(frozen=True, slots=True)
class AxisMotion:
    """What a positive position of an axis does to the part of the machine that it moves.

    Attributes:
        parent: Name of the axis that carries this one; empty: the frame does.
        axis: Unit vector along or about which it moves, in machine coordinates, shape (3,).
        origin: A point on the axis of what turns, with all axes at zero, from the spindle nose there, shape (3,)
            [mm]; None of what slides.
    """

    type: Literal["PRISMATIC", "REVOLUTE", "CONTINUOUS"]
    parent: str
    axis: tuple[float, ...]
    origin: tuple[float, ...] | None


def motions_of(axes: Axes, chain: Kinematics, endless: Collection[str]) -> dict[str, AxisMotion]:
    """The motion of every axis by its name.

    A joint that carries the part moves against the coordinates that count it (ISO 841), so its direction is
    turned round: what is given is how the machine's own part moves.

    Args:
        chain: The machine's joints, from the tool over the frame to the part, with all axes at zero.
        endless: Names of the axes that turn without end.
    """
    found, names = {}, [axes.names[column] for column in chain.column]
    count = len(names)
    for joint, name in enumerate(names):
        on_tool = bool(chain.on_tool[joint])
        carrier = joint + 1 if on_tool else joint - 1
        carried = 0 <= carrier < count and bool(chain.on_tool[carrier]) is on_tool
        kind = ("CONTINUOUS" if name in endless else "REVOLUTE") if chain.rotary[joint] else None
        found[name] = AxisMotion(
            kind or "PRISMATIC",
            names[carrier] if carried else "",
            _plain(chain.axis[joint] if on_tool else -chain.axis[joint]),
            _plain(chain.anchor[joint]) if kind else None,
        )
    return found


def _plain(vector: FloatArray) -> tuple[float, ...]:
    """A vector without negative zeros."""
    return tuple(round(float(value), _DIGITS) + 0.0 for value in vector)


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

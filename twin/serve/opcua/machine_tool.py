"""The address space of one machine: a MachineToolType of OPC 40501-1, kept up to date.

What the specification has no place for, positions and loads of axes, is in a folder of the machine's own
namespace below Monitoring, as analogue items with engineering units.
"""

import datetime as dt
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import asyncua.ua
from asyncua.common.node import Node
from asyncua.server.server import Server

from twin.errors import UsageError
from twin.machine.description.config import MachineConfig
from twin.serve.buffer import Condition, Observation
from twin.serve.device import UNAVAILABLE
from twin.serve.opcua.alarm import ConditionNode

FOLDER = Path(__file__).with_name("nodesets")
DI = "http://opcfoundation.org/UA/DI/"
MACHINERY = "http://opcfoundation.org/UA/Machinery/"
MACHINE_TOOL = "http://opcfoundation.org/UA/MachineTool/"
_VERSION = FOLDER / "VERSION"
"""Written when all are there."""


def require_node_sets() -> None:
    """Refuse where they are missing.

    Raises:
        UsageError: They are.
    """
    if not _VERSION.is_file():
        raise UsageError(
            f"OPC UA's node sets are missing ({FOLDER}): run python scripts/fetch_three.py"
        )


async def import_node_sets(server: Server) -> None:
    """Give a server the types of machine tools.

    Args:
        server: Before it is started.

    Raises:
        UsageError: The node sets are not there.
    """
    require_node_sets()
    # By their numbers: each builds on those before it.
    for file in sorted(FOLDER.glob("*.xml")):
        # Some nodes of DI are for design tools only and have no parent: they are left out.
        await server.import_xml(str(file), strict_mode=False)


ua: Any = asyncua.ua
"""Its declared types are narrower than what its own calls take."""
NAMESPACE = "urn:mill-twin:machine"
MANUFACTURER = "mill-twin"
_CHANNEL_MODES = {
    "AUTOMATIC": 0, "SEMI_AUTOMATIC": 0, "MANUAL_DATA_INPUT": 1, "MANUAL": 2,
}  # fmt: skip
"""``ChannelMode`` by MTConnect's ``CONTROLLER_MODE``."""
_OPERATION_MODES = {mode: int(channel == 0) for mode, channel in _CHANNEL_MODES.items()}
"""``MachineOperationMode``: 0 by hand, 1 automatic."""
_CHANNEL_STATES = {"ACTIVE": 0, "FEED_HOLD": 1, "STOPPED": 1}
_CHANNEL_RESET = 2
_PROGRAM_STATES = {
    "READY": "Initializing", "ACTIVE": "Running", "FEED_HOLD": "Interrupted", "STOPPED": "Aborted",
    "PROGRAM_COMPLETED": "Ended",
}  # fmt: skip
"""States of ``ProductionStateMachineType`` by MTConnect's ``EXECUTION``."""
_NUMBER_BASED, _NEVER_LOCKED = 0, 0
"""``ToolManagement`` and ``ToolLocked``: the twin locks no tool."""
_LARGEST_OVERRIDE = 120.0
"""That the dials of the twin's panel give [%]."""
_UNECE = "http://www.opcfoundation.org/UA/units/un/cefact"
_UNITS = {
    "mm": (5066068, "mm", "millimetre"),
    "deg": (17476, "°", "degree [unit of angle]"),
    "%": (20529, "%", "percent"),
    "mm/s": (4403766, "mm/s", "millimetre per second"),
    "rpm": (5394509, "rpm", "revolutions per minute"),
}
"""UNECE codes, as OPC UA counts them, with symbol and name."""


class _Item(NamedTuple):
    """A variable that follows a data item of the agent."""

    node: Node
    value: Callable[[str], Any]


def _double(text: str) -> Any:
    return ua.Variant(float(text), ua.VariantType.Double)


def _string(text: str) -> Any:
    return ua.Variant(text, ua.VariantType.String)


def _unit(name: str) -> Any:
    code, symbol, words = _UNITS[name]
    return ua.EUInformation(_UNECE, code, ua.LocalizedText(symbol), ua.LocalizedText(words))


def _count(text: str) -> Any:
    return ua.Variant(int(text), ua.VariantType.UInt32)


def _number_in(table: Mapping[str, int]) -> Callable[[str], Any]:
    return lambda text: ua.Variant(table[text], ua.VariantType.Int32)


class MachineTool:
    """A machine in a server's address space."""

    def __init__(self, server: Server, machine: MachineConfig) -> None:
        """Begin with nothing; ``build`` makes the nodes.

        Args:
            machine: Whose axes and name are shown.
        """
        self._server, self._machine = server, machine
        self._items: dict[str, list[_Item]] = {}
        self._states: dict[str, Any] = {}
        self._programs: list[tuple[Node, Node]] = []
        self._channel_state: Node | None = None
        self._alarm = ConditionNode(server)
        self._rotating: Node | None = None

    async def build(self, program: str, tools: Mapping[int, str]) -> None:
        """Make the nodes.

        Args:
            tools: Names of the tools by their numbers.
        """
        server = self._server
        self._own = await server.register_namespace(NAMESPACE)
        self._di = await server.get_namespace_index(DI)
        self._mt = await server.get_namespace_index(MACHINE_TOOL)
        machinery = await server.get_namespace_index(MACHINERY)
        machines = await server.nodes.objects.get_child([f"{machinery}:Machines"])
        self.node = await self._object(
            machines, self._own, self._machine.file.name, "MachineToolType"
        )
        await self._identify()
        monitoring = await self._child(self.node, "Monitoring")
        await self._monitor(monitoring)
        await self._axes(monitoring)
        await self._produce(await self._child(self.node, "Production"), program)
        await self._equip(await self._child(self.node, "Equipment"), tools)
        await self._notify(await self._child(self.node, "Notification"))

    async def update(self, observation: Observation) -> None:
        """Take over what the agent observed."""
        value, when = observation.value, dt.datetime.fromisoformat(observation.time)
        if isinstance(value, Condition):
            await self._alarm.observe(value, when)
            return
        for item in self._items.get(observation.item, ()):
            known = value != UNAVAILABLE
            status = ua.StatusCode(
                ua.StatusCodes.Good if known else ua.StatusCodes.BadWaitingForInitialData
            )
            variant = item.value(value) if known else ua.Variant(None)
            data = ua.DataValue(variant, status, SourceTimestamp=when)
            await self._server.write_attribute_value(item.node.nodeid, data)
        if observation.item == "execution" and value in _PROGRAM_STATES:
            await self._execution(value)
        if observation.item == "spindle_speed" and self._rotating is not None:
            await self._rotating.write_value(value not in (UNAVAILABLE, "0"))

    async def _type(self, name: str) -> Any:
        """A type of the machine tools' namespace."""
        pending = [self._server.nodes.base_object_type]
        while pending:
            node = pending.pop()
            found = await node.read_browse_name()
            if (found.NamespaceIndex, found.Name) == (self._mt, name):
                return node.nodeid
            pending += await node.get_children(refs=ua.ObjectIds.HasSubtype)
        raise LookupError(name)

    async def _object(self, parent: Node, namespace: int, name: str, kind: str) -> Node:
        """An instance with what its type demands, and nothing that stays empty."""
        return await parent.add_object(
            ua.NodeId(NamespaceIndex=self._own), ua.QualifiedName(name, namespace),
            objecttype=await self._type(kind), instantiate_optional=False,
        )  # fmt: skip

    async def _child(self, parent: Node, *names: str) -> Node:
        return await parent.get_child([f"{self._mt}:{name}" for name in names])

    async def _variable(self, parent: Node, name: str, value: Any) -> Node:
        """An optional variable of the specification."""
        named = ua.QualifiedName(name, self._mt)
        return await parent.add_variable(ua.NodeId(NamespaceIndex=self._own), named, value)

    def _follow(self, item: str, node: Node, value: Callable[[str], Any]) -> None:
        self._items.setdefault(item, []).append(_Item(node, value))

    async def _identify(self) -> None:
        node = await self.node.get_child([f"{self._di}:Identification"])
        name = self._machine.file.name
        values: dict[str, Any] = {
            "Manufacturer": ua.LocalizedText(MANUFACTURER),
            "ProductInstanceUri": f"{NAMESPACE}:{name}",
            "SerialNumber": name,
        }
        for key, value in values.items():
            await (await node.get_child([f"{self._di}:{key}"])).write_value(value)
        model = ua.Variant(ua.LocalizedText(name), ua.VariantType.LocalizedText)
        await node.add_property(
            ua.NodeId(NamespaceIndex=self._own), ua.QualifiedName("Model", self._di), model
        )

    async def _monitor(self, monitoring: Node) -> None:
        whole = await self._child(monitoring, "MachineTool")
        mode = await self._child(whole, "OperationMode")
        self._follow("mode", mode, _number_in(_OPERATION_MODES))
        await self._override(whole, "FeedOverride", "feed_override")
        channel = await self._object(monitoring, self._own, "Channel1", "ChannelMonitoringType")
        await (await self._child(channel, "Name")).write_value("Channel1")
        mode = await self._child(channel, "ChannelMode")
        self._follow("mode", mode, _number_in(_CHANNEL_MODES))
        await self._override(channel, "FeedOverride", "feed_override")
        await self._override(channel, "RapidOverride", "rapid_override")
        self._channel_state = await self._child(channel, "ChannelState")
        feed = await self._analogue(channel, "PathFeedrate", "mm/s")
        self._follow("path_feedrate", feed, _double)
        for name, item in (("Line", "line"), ("Block", "block"), ("ToolNumber", "tool_number")):
            empty = ua.Variant("", ua.VariantType.String)
            node = await channel.add_variable(self._own, name, empty)
            self._follow(item, node, _string)
        spindle = await self._object(monitoring, self._own, "Spindle", "SpindleMonitoringType")
        await (await self._child(spindle, "Name")).write_value("S")
        await self._override(spindle, "Override", "spindle_override")
        self._rotating = rotating = await self._child(spindle, "IsRotating")
        await rotating.write_value(False)
        self._follow("spindle_speed", await self._analogue(spindle, "Speed", "rpm"), _double)
        self._follow("spindle_load", await self._analogue(spindle, "Load", "%"), _double)

    async def _override(self, parent: Node, name: str, item: str) -> None:
        """An override, with its unit and range; an optional one is made."""
        try:
            node = await self._child(parent, name)
            unit = await node.get_child(["0:EngineeringUnits"])
            limits = await node.get_child(["0:EURange"])
        except ua.UaError:
            empty = ua.Variant(0.0, ua.VariantType.Double)
            node = await parent.add_variable(
                ua.NodeId(NamespaceIndex=self._own), ua.QualifiedName(name, self._mt), empty,
                datatype=ua.NodeId(ua.ObjectIds.Double),
            )  # fmt: skip
            place = ua.NodeId(NamespaceIndex=self._own)
            unit = await node.add_property(
                place, ua.QualifiedName("EngineeringUnits", 0), _unit("%")
            )
            whole = ua.Range(0.0, _LARGEST_OVERRIDE)
            limits = await node.add_property(place, ua.QualifiedName("EURange", 0), whole)
        await unit.write_value(_unit("%"))
        await limits.write_value(ua.Range(0.0, _LARGEST_OVERRIDE))
        self._follow(item, node, _double)

    async def _axes(self, monitoring: Node) -> None:
        folder = await monitoring.add_folder(self._own, "Axes")
        for name in self._machine.axes.names:
            axis = await folder.add_object(self._own, name)
            unit = "mm" if self._machine.axis(name).kind == "linear" else "deg"
            for key, item, own in (
                ("ActualPosition", "position", unit),
                ("CommandedPosition", "position_commanded", unit),
                ("Load", "load", "%"),
            ):
                self._follow(f"{name}_{item}", await self._analogue(axis, key, own), _double)

    async def _analogue(self, parent: Node, name: str, unit: str) -> Node:
        """A double of the machine's own namespace with its engineering unit."""
        empty = ua.Variant(0.0, ua.VariantType.Double)
        node = await parent.add_variable(self._own, name, empty)
        property_name = ua.QualifiedName("EngineeringUnits", 0)
        await node.add_property(ua.NodeId(NamespaceIndex=self._own), property_name, _unit(unit))
        return node

    async def _produce(self, production: Node, program: str) -> None:
        active = await self._child(production, "ActiveProgram")
        name = await self._child(active, "Name")
        await name.write_value(program)
        self._follow("program", name, _string)
        number = await active.get_child(["0:NumberInList"])
        await number.write_value(ua.Variant(0, ua.VariantType.UInt16))
        state_type = self._server.get_node(await self._type("ProductionStateMachineType"))
        for state in set(_PROGRAM_STATES.values()):
            self._states[state] = (await self._child(state_type, state)).nodeid
        plan = await self._object(production, self._mt, "ProductionPlan", "ProductionJobListType")
        job = await self._object(plan, self._own, program, "ProductionJobType")
        await (await self._child(job, "Identifier")).write_value(program)
        await (await job.get_child(["0:NumberInList"])).write_value(
            ua.Variant(0, ua.VariantType.UInt16)
        )
        programs = await self._child(job, "ProductionPrograms")
        for example in await programs.get_children():
            await example.delete()
        only = await self._object(programs, self._own, program, "ProductionProgramType")
        await (await self._child(only, "Name")).write_value(program)
        await (await only.get_child(["0:NumberInList"])).write_value(
            ua.Variant(0, ua.VariantType.UInt16)
        )
        planned = await self._child(job, "RunsPlanned")
        await planned.write_value(ua.Variant(0, ua.VariantType.UInt32))
        # The twin makes part after part without an end: there is no number to plan for.
        await (await self._child(planned, "IsValid")).write_value(False)
        completed = await self._child(job, "RunsCompleted")
        self._follow("part_count", completed, _count)
        for owner in (active, job):
            machine = await self._child(owner, "State")
            current = await machine.get_child(["0:CurrentState"])
            self._programs.append((current, await current.get_child(["0:Id"])))
        await self._execution("READY")

    async def _equip(self, equipment: Node, tools: Mapping[int, str]) -> None:
        place = await self._object(equipment, self._mt, "Tools", "ToolListType")
        for number, name in sorted(tools.items()):
            tool = await self._object(place, self._own, f"T{number}", "ToolType")
            identifier = await self._child(tool, "ControlIdentifier1")
            await identifier.write_value(ua.Variant(number, ua.VariantType.UInt32))
            await (await self._child(tool, "Locked")).write_value(False)
            await self._variable(tool, "Name", ua.Variant(name, ua.VariantType.String))

    async def _notify(self, notification: Node) -> None:
        messages = await self._object(notification, self._mt, "Messages", "MessagesType")
        kind = self._server.get_node(await self._type("AlertType"))
        await self._alarm.build(messages, kind, self._own)

    async def _execution(self, value: str) -> None:
        state = _PROGRAM_STATES[value]
        for current, identifier in self._programs:
            await current.write_value(ua.LocalizedText(state))
            await identifier.write_value(self._states[state])
        if self._channel_state is not None:
            number = _CHANNEL_STATES.get(value, _CHANNEL_RESET)
            await self._channel_state.write_value(ua.Variant(number, ua.VariantType.Int32))

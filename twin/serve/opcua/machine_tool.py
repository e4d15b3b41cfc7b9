"""The address space of one machine: a MachineToolType of OPC 40501-1, kept up to date.

What the specification has no place for, positions and loads of axes, stands in a folder of the machine's own
namespace below Monitoring, as analogue items with engineering units.
"""

import datetime as dt
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import asyncua.ua
from asyncua.common.node import Node
from asyncua.server.server import Server

from twin.machine.description.config import Machine
from twin.serve.buffer import Condition, Observation
from twin.serve.device import UNAVAILABLE
from twin.serve.opcua.node_sets import DI, MACHINE_TOOL, MACHINERY

ua: Any = asyncua.ua
"""Its declared types are narrower than what its own calls take."""
NAMESPACE = "urn:mill-twin:machine"
MANUFACTURER = "mill-twin"
_CHANNEL_AUTOMATIC, _MODE_AUTOMATIC = 0, 1
_CHANNEL_STATES = {"ACTIVE": 0, "STOPPED": 1, "INTERRUPTED": 1}
_CHANNEL_RESET = 2
_PROGRAM_STATES = {
    "READY": "Initializing", "ACTIVE": "Running", "INTERRUPTED": "Interrupted", "STOPPED": "Aborted",
    "PROGRAM_COMPLETED": "Ended",
}  # fmt: skip
"""States of ``ProductionStateMachineType`` by MTConnect's ``EXECUTION``."""
_NUMBER_BASED, _NEVER_LOCKED = 0, 0
"""``ToolManagement`` and ``ToolLocked``: the twin locks no tool."""
_FULL = 100.0
_SEVERITY = 800
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


class MachineTool:
    """A machine in a server's address space."""

    def __init__(self, server: Server, machine: Machine) -> None:
        """Begin with nothing; ``build`` makes the nodes.

        Args:
            server: With the node sets.
            machine: Whose axes and name are shown.
        """
        self._server, self._machine = server, machine
        self._items: dict[str, list[_Item]] = {}
        self._states: dict[str, Any] = {}
        self._programs: list[tuple[Node, Node]] = []
        self._channel_state: Node | None = None
        self._alarm: Any = None
        self._fault = Condition("Normal")
        self._rotating: Node | None = None

    async def build(self, program: str, tools: Mapping[int, str]) -> None:
        """Make the nodes.

        Args:
            program: Name of the NC program.
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
            await self._condition(value)
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
        full = ua.Variant(_FULL, ua.VariantType.Double)
        whole = await self._child(monitoring, "MachineTool")
        mode = await self._child(whole, "OperationMode")
        await mode.write_value(ua.Variant(_MODE_AUTOMATIC, ua.VariantType.Int32))
        await self._variable(whole, "FeedOverride", full)
        channel = await self._object(monitoring, self._own, "Channel1", "ChannelMonitoringType")
        await (await self._child(channel, "Name")).write_value("Channel1")
        automatic = ua.Variant(_CHANNEL_AUTOMATIC, ua.VariantType.Int32)
        await (await self._child(channel, "ChannelMode")).write_value(automatic)
        override = await self._child(channel, "FeedOverride")
        await override.write_value(full)
        await (await override.get_child(["0:EngineeringUnits"])).write_value(_unit("%"))
        whole_range = ua.Range(0.0, _FULL)
        await (await override.get_child(["0:EURange"])).write_value(whole_range)
        await self._variable(channel, "RapidOverride", full)
        self._channel_state = await self._child(channel, "ChannelState")
        feed = await self._analogue(channel, "PathFeedrate", "mm/s")
        self._follow("path_feedrate", feed, _double)
        for name, item in (("Line", "line"), ("Block", "block"), ("ToolNumber", "tool_number")):
            empty = ua.Variant("", ua.VariantType.String)
            node = await channel.add_variable(self._own, name, empty)
            self._follow(item, node, _string)
        spindle = await self._object(monitoring, self._own, "Spindle", "SpindleMonitoringType")
        await (await self._child(spindle, "Name")).write_value("S")
        await self._variable(spindle, "Override", full)
        self._rotating = await self._child(spindle, "IsRotating")
        await self._rotating.write_value(False)
        self._follow("spindle_speed", await self._analogue(spindle, "Speed", "rpm"), _double)

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
        self._alarm = await self._server.get_event_generator(kind, self._server.nodes.server.nodeid)
        event = self._alarm.event
        event.SourceNode, event.SourceName = messages.nodeid, "Messages"
        event.ConditionName, event.BranchId = "system", ua.NodeId()
        event.InputNode, event.Retain = ua.NodeId(), False

    async def _execution(self, value: str) -> None:
        state = _PROGRAM_STATES[value]
        for current, identifier in self._programs:
            await current.write_value(ua.LocalizedText(state))
            await identifier.write_value(self._states[state])
        if self._channel_state is not None:
            number = _CHANNEL_STATES.get(value, _CHANNEL_RESET)
            await self._channel_state.write_value(ua.Variant(number, ua.VariantType.Int32))

    async def _condition(self, value: Condition) -> None:
        """Raise an alert where a fault begins, and end it where the fault does."""
        if self._alarm is None or value == self._fault or value.level == "Unavailable":
            return
        active = value.level == "Fault"
        told = value if active else self._fault
        event = self._alarm.event
        event.add_property("ErrorCode", told.code, ua.VariantType.String)
        event.Message = ua.LocalizedText(told.text)
        event.Severity = _SEVERITY if active else 1
        event.Retain = active
        event.ActiveState = ua.LocalizedText("Active" if active else "Inactive")
        event.add_property("ActiveState/Id", active, ua.VariantType.Boolean)
        event.EnabledState = ua.LocalizedText("Enabled")
        event.add_property("EnabledState/Id", True, ua.VariantType.Boolean)
        self._fault = value
        await self._alarm.trigger()

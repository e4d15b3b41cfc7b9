"""The machine's alarm as a condition of OPC UA 10000-9: an instance that stays, and events of its changes."""

import datetime as dt
from typing import Any

import asyncua.ua
from asyncua.common.node import Node
from asyncua.server.server import Server

from twin.serve.buffer import NORMAL, Condition

ua: Any = asyncua.ua
NAME = "System"
"""Of the condition, as of the data item that it follows."""
_SEVERITIES = {"Fault": 800, "Warning": 400, "Normal": 1}
"""Of 1 to 1000: an alarm stops the machine, a warning does not."""


class ConditionNode:
    """One condition, which is active while a fault or a warning is there.

    Nobody has to acknowledge it: like a read-only monitor of a control, the server takes no orders.
    """

    def __init__(self, server: Server) -> None:
        self._server = server
        self._last = NORMAL
        self._fields: dict[str, Node] = {}

    async def build(self, source: Node, kind: Node, namespace: int) -> None:
        """Make the instance below its source."""
        server = self._server
        place, name = ua.NodeId(NamespaceIndex=namespace), ua.QualifiedName(NAME, namespace)
        self.node = await source.add_object(place, name, kind.nodeid, instantiate_optional=False)
        await source.add_reference(self.node, ua.ObjectIds.HasCondition)
        self._generator = await server.get_event_generator(kind, server.nodes.server.nodeid)
        for field in await _variables(self.node):
            name = (await field.read_browse_name()).Name
            self._fields[name] = field
            for part in await _variables(field):
                self._fields[f"{name}/{(await part.read_browse_name()).Name}"] = part
        self._set({
            "NodeId": self.node.nodeid,
            "SourceNode": source.nodeid,
            "SourceName": (await source.read_browse_name()).Name,
            "ConditionClassId": ua.NodeId(ua.ObjectIds.SystemConditionClassType),
            "ConditionClassName": ua.LocalizedText("System"),
            "ConditionName": NAME,
            "BranchId": ua.NodeId(),
            "EnabledState": ua.LocalizedText("Enabled"),
            "EnabledState/Id": True,
            "AckedState": ua.LocalizedText("Acknowledged"),
            "AckedState/Id": True,
            "Quality": ua.StatusCode(ua.StatusCodes.Good),
            "Comment": ua.LocalizedText(""),
            "ClientUserId": "",
            "InputNode": ua.NodeId(),
            "SuppressedOrShelved": False,
        })  # fmt: skip
        # The library knows no type for a property of another namespace.
        self._generator.event.data_types["ErrorCode"] = ua.VariantType.String
        self._change(NORMAL, "", "")
        await self._show()

    async def observe(self, value: Condition, when: dt.datetime) -> None:
        """Send an event where a condition has changed.

        Args:
            when: Since when.
        """
        if value == self._last or value.level not in _SEVERITIES:
            return
        # The end of an alarm repeats its code and text.
        shown = self._last if value.level == "Normal" else value
        self._change(value, shown.code, shown.text)
        self._last = value
        await self._generator.trigger(when)
        await self._show()

    def _change(self, value: Condition, code: str, text: str) -> None:
        active = value.level != "Normal"
        self._set({
            "ErrorCode": code,
            "Message": ua.LocalizedText(text),
            "LastSeverity": _SEVERITIES[self._last.level],
            "Severity": _SEVERITIES[value.level],
            "Retain": active,
            "ActiveState": ua.LocalizedText("Active" if active else "Inactive"),
            "ActiveState/Id": active,
        })  # fmt: skip

    def _set(self, values: dict[str, Any]) -> None:
        for name, value in values.items():
            setattr(self._generator.event, name, value)

    async def _show(self) -> None:
        """Let the instance's variables have the values of the last event."""
        event = self._generator.event
        for name, node in self._fields.items():
            value = getattr(event, name, None)
            if isinstance(value, ua.Variant):
                await node.write_value(value)
            elif value is not None:
                await node.write_value(ua.Variant(value, event.data_types[name]))


async def _variables(node: Node) -> list[Node]:
    return await node.get_children(ua.ObjectIds.Aggregates, nodeclassmask=ua.NodeClass.Variable)

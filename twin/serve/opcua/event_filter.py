"""Event filters of clients by type: an event is also of all types that its own type is a subtype of.

OPC UA 10000-4, 7.7.3 has ``OfType`` so; ``asyncua`` compares the event's own type alone, and clients that ask for all
alarms by ``AlarmConditionType`` or ``AcknowledgeableConditionType`` would receive none.
"""

from typing import Any

import asyncua.ua
from asyncua.server import monitored_item_service
from asyncua.server.monitored_item_service import WhereClauseEvaluator

ua: Any = asyncua.ua


class SubtypeEvaluator(WhereClauseEvaluator):
    """The library's evaluator, for which a type holds its subtypes."""

    def _eval_el(self, index: int, event: Any) -> Any:
        element: Any = self.elements[index]
        if element.FilterOperator != ua.FilterOperator.OfType:
            return super()._eval_el(index, event)
        wanted, kind = self._eval_op(element.FilterOperands[0], event), event.EventType
        while kind is not None and kind != wanted:
            kind = self._supertype(kind)
        return kind is not None

    def _supertype(self, kind: Any) -> Any:
        has_subtype = ua.NodeId(ua.ObjectIds.HasSubtype)
        return next(
            (
                reference.NodeId
                for reference in self._aspace[kind].references
                if reference.ReferenceTypeId == has_subtype and not reference.IsForward
            ),
            None,
        )


def filter_by_subtypes() -> None:
    """Let servers of this process evaluate filters so."""
    monitored_item_service.WhereClauseEvaluator = SubtypeEvaluator

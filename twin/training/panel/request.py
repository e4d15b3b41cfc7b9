"""What the panel asks for: a command for the machine, or something to be done to the session."""

import dataclasses
from typing import Any, Literal

from twin.training.session.log import Who

Change = Literal["freeze", "go_on", "rewind", "replay"]


@dataclasses.dataclass(frozen=True, slots=True)
class Request:
    """One request.

    Attributes:
        who: Who asks.
        command: A command as plain data, or None.
        change: What to do to the session, or None.
        seconds: How far to go back [s].
    """

    who: Who = "operator"
    command: dict[str, Any] | None = None
    change: Change | None = None
    seconds: float = 0.0


def do(name: str, **arguments: Any) -> Request:
    """An operator's command."""
    return Request(command={"do": name, **arguments})

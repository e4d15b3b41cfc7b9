"""Types of variables: what an assignment makes of a value."""

import enum

from twin.nc.text.arithmetic import nearest_whole_away


class VariableType(enum.Enum):
    """Those that the twin computes with; texts are kept as they are written."""

    REAL = "REAL"
    INT = "INT"
    BOOL = "BOOL"
    CHAR = "CHAR"
    STRING = "STRING"
    AXIS = "AXIS"

    def converted(self, value: float) -> float:
        """A value as a variable of this type holds it."""
        if self is VariableType.BOOL:
            return 1.0 if value != 0.0 else 0.0
        if self in (VariableType.INT, VariableType.CHAR):
            return nearest_whole_away(value)
        return value


TEXTS = (VariableType.STRING, VariableType.AXIS)
"""Types whose values are texts."""

"""What the words of canonical functions ask of a machine, for all who act on them."""

SPINDLE_CLOCKWISE = "M3"
SPINDLE_COUNTER_CLOCKWISE = "M4"
SPINDLE_STARTS = frozenset({SPINDLE_CLOCKWISE, SPINDLE_COUNTER_CLOCKWISE})
SPINDLE_STOPS = frozenset({"M5", "M19"})
"""M19 holds the spindle at an angle."""
SPINDLE_SPEED = "S"
"""Sets the speed, and starts nothing."""
COOLANT_ON = frozenset({"M7", "M8"})
COOLANT_OFF = frozenset({"M9"})
TOOL_CHANGE = "M6"
PROGRAM_STOPS = frozenset({"M0", "M1"})
"""The operator starts the program again."""
PROGRAM_ENDS = frozenset({"M2", "M30"})
"""The spindle and the coolant end with the program."""

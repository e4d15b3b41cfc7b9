"""What the machine does by itself when a tool changes: what a job or a machine file says of it."""

from twin.files.toml import Table


class ToolChangeTable(Table):
    """The tool change."""

    height: float | None = None
    """Z that the control, or the builder's macro behind M6, rises to by itself before the tool changes, machine
    coordinates [mm]; none: a Haas rises to machine zero, other controls change the tool where it stands."""

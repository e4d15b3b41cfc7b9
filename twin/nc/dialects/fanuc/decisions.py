"""What the project decided where parameters or the machine's builder decide, or manuals are silent."""

from twin.nc.control.dialect import Decision

DECISIONS: tuple[Decision, ...] = ()

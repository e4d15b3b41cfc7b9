"""What a job holds its runs to: tolerances, and its baseline."""

from typing import Annotated

import pydantic
from pydantic import Field

from twin.files.toml import Table
from twin.job.builder import Positive

DEFAULT_CONTOUR_UM = 20.0
"""Contour tolerance of a job that names none [µm]: what a general mill holds under IT7."""


class BlocksToleranceTable(Table):
    """A tolerance for a range of program lines; of several that hold one line, the last counts."""

    lines: tuple[Annotated[int, Field(ge=1)], Annotated[int, Field(ge=1)]]
    """First and last source line, both included."""
    contour_um: Positive
    """Largest contour error there, rapids included [µm]."""

    @pydantic.field_validator("lines")
    @classmethod
    def _in_order(cls, lines: tuple[int, int]) -> tuple[int, int]:
        if lines[0] > lines[1]:
            raise ValueError("lines must be [first, last]")
        return lines


class ToleranceTable(Table):
    """What the verdict holds the run to."""

    contour_um: Positive = DEFAULT_CONTOUR_UM
    """Largest distance from the commanded path, seen from the part [µm]."""
    rapid_contour_um: Positive | None = None
    """Largest contour error during rapids [µm]; none: they are held to ``contour_um`` too."""
    blocks: tuple[BlocksToleranceTable, ...] = ()
    """Other contour tolerances for ranges of lines."""
    corner_um: Positive | None = None
    """How far a corner may be rounded: nearest the tool comes to it [µm]; none: not judged."""
    circular_deviation_um: Positive | None = None
    """Of every arc of at least 90 degrees [µm]; none: not judged."""
    following_um: Positive | None = None
    """Largest following error of a linear axis [µm]; none: not judged."""
    following_mdeg: Positive | None = None
    """Largest following error of a rotary axis [mdeg]; none: not judged."""
    direction_mdeg: Positive | None = None
    """Largest angle between the tool's commanded and simulated directions in the part, on machines whose axes tilt
    the one against the other [mdeg]; none: not judged."""
    force_n: Positive | None = None
    """Greatest cutting force in a turn [N]; none: not judged; force must be simulated, as for the next three."""
    power_w: Positive | None = None
    """Greatest power of the cut [W]; none: not judged."""
    deflection_um: Positive | None = None
    """Greatest deflection of the tool's tip [µm]; none: not judged."""
    chip_mm: Positive | None = None
    """Thickest chip [mm]; none: not judged."""
    cycle_time_s: Positive | None = None
    """Longest machine time of the program [s]; none: not judged."""


class BaselineTable(Table):
    """How far a run may be from its baseline (``twin check --baseline``)."""

    path_um: Positive = 1.0
    """Start, end or centre of a block [µm or mdeg]."""
    feed_percent: Annotated[float, Field(ge=0)] = 0.1
    """Commanded feed of a block, up or down."""
    cycle_time_percent: Annotated[float, Field(ge=0)] = 1.0
    """Change of the cycle time, up or down."""
    contour_um: Annotated[float, Field(ge=0)] = 1.0
    """Growth of the greatest contour error [µm]."""
    cut_percent: Annotated[float, Field(ge=0)] = 1.0
    """Change of the volume that is cut, of each tool's, and of the share of air, up or down."""

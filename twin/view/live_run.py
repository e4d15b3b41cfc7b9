"""What a page shows of a run that goes on: where the machine is now, and its program."""

import dataclasses
import struct
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.heights.patches import grid_of, patch_message
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray
from twin.render.machine_glb import DrawnMachine, drawn_machine
from twin.run.preparing.preparation import Preparation


@dataclasses.dataclass(frozen=True, slots=True)
class MachineMoment:
    """Where a machine is.

    Attributes:
        time_s: Since the run began [s].
        line: Source line of the block that runs; 0: none.
        position: Machine coordinates, shape (k,) [mm or deg].
    """

    time_s: float
    line: int
    position: FloatArray


class LiveRun:
    """A run that goes on; its stock is shown as the blank, with the job's first tool in the spindle."""

    def __init__(self, preparation: Preparation, moment: Callable[[], MachineMoment]) -> None:
        """Take a prepared job.

        Args:
            moment: Where the machine is, asked from another thread.
        """
        self._preparation = preparation
        self._frame, self._zero = preparation.layout.part_frame, preparation.layout.part_zero
        self._moment = moment

    @property
    def _machine(self) -> MachineConfig:
        return self._preparation.machine

    def now(self) -> dict[str, Any]:
        """Where the machine is, as a page shows it; ``tip`` is seen from the part [mm]."""
        found = self._moment()
        return {
            "time": found.time_s,
            "line": found.line,
            "machine": found.position.tolist(),
            "tip": self._frame.position(found.position[None])[0].tolist(),
        }

    def description(self) -> dict[str, Any]:
        """What is shown once, as of a recorded run."""
        preparation = self._preparation
        return {
            "program": preparation.source.name,
            "machine": self._machine.file.name,
            "dialect": preparation.dialect.name,
            "axes": self._machine.axes.names,
            "kinds": self._machine.axes.kinds,
            "part_zero": self._zero.tolist(),
            "source": [line.rstrip("\r\n") for line in preparation.source.lines],
            "alarms": [],
            "error_scale_um": 0.0,
            "has_error": False,
            "goes_on": True,
            "tools": [tool.number for tool in preparation.job.file.tools],
        }

    def samples(self) -> bytes:
        """The present moment alone, in the form of a recorded run's samples."""
        found = self._moment()
        tip = self._frame.position(found.position[None])[0]
        tool = self._preparation.job.file.tools[0].number
        row = [found.time_s, found.line, tool, 0.0, 0.0, 0.0, *tip, *found.position]
        return struct.pack("<II", 1, len(found.position)) + np.array(row, "<f4").tobytes()

    has_part_mesh = False
    """No cut is shown of a run that is made now: the blank is drawn as a height map."""

    def stock_grid(self) -> dict[str, object] | None:
        """The grid of the stock; None where there is none."""
        cutter = self._cutter()
        return None if cutter is None else grid_of(cutter.map)

    def cuts(self) -> Iterator[bytes]:
        """The blank, in the form of a recorded run's cuts."""
        cutter = self._cutter()
        if cutter is not None:
            rows, columns = cutter.map.heights.shape
            patch = patch_message(cutter.map, (0, rows, 0, columns))
            yield struct.pack("<If", len(patch), 0.0) + patch

    def _cutter(self) -> Cutter | None:
        job = self._preparation.job.file
        if job.stock is None:
            return None
        return Cutter(job.stock, job.tools[0], self._frame, self._zero)

    def drawn(self, number: int) -> DrawnMachine | None:
        """The machine with one of the job's tools; None where there is no such tool."""
        job = self._preparation.job.file
        for tool in job.tools:
            if tool.number == number:
                return drawn_machine(self._machine, tool, self._frame, job.stock, self._zero)
        return None

"""What a page shows of a recording: its samples, thinned where they are many, and the stock's cuts."""

import itertools
import struct
from collections.abc import Iterator
from typing import Any

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.heights.patches import grid_of, patch_message
from twin.cutting.tridexel.material import TriDexelMaterial
from twin.cutting.tridexel.surface.mesh import mesh_message
from twin.machine.description.config import MachineConfig
from twin.nc.canonical import FloatArray, IntArray
from twin.recording.reader import Samples
from twin.render.machine_glb import DrawnMachine, drawn_machine
from twin.render.scene.scene import RenderScene
from twin.units import SECONDS_PER_MINUTE

MOST_SAMPLES = 100_000
"""Samples that a page gets; of more every n-th, and the greatest contour error of each group."""
CUTS = 200
"""Moments between which the stock is cut: so finely it is seen when it is scrubbed."""
MESHES = 40
"""Moments at which a part that is cut from several sides is seen."""
CROSSINGS, LAST_CROSSINGS = 5_000, 15_000
"""Crossings of the lattice by the mesh of such a part while it is cut, and of the finished one; see ``mesh_message``."""


class RecordedRun:
    """A recording with all that its page needs."""

    def __init__(self, scene: RenderScene, machine: MachineConfig) -> None:
        """Take a recording, which must stay open.

        Args:
            scene: The recording with its program, stock and tools.
        """
        self._scene = scene
        self._machine = machine
        recording = scene.recording
        self._every = max(1, -(-len(recording) // MOST_SAMPLES))

    def description(self) -> dict[str, Any]:
        """What is shown once: axes, program, alarms, the scale of the contour error."""
        scene, recording = self._scene, self._scene.recording
        header = recording.header
        return {
            "program": header.program,
            "machine": header.machine,
            "dialect": header.dialect,
            "axes": header.axes.names,
            "kinds": header.axes.kinds,
            "part_zero": header.part_zero.tolist(),
            "source": [line.rstrip("\r\n") for line in scene.source],
            "alarms": recording.alarms,
            "error_scale_um": scene.error_scale,
            "has_error": recording.contour_um(0, 0) is not None,
            "tools": [tool.number for tool in scene.summary.tools.tools],
        }

    def samples(self) -> bytes:
        """The samples: number of them n and of axes k, then columns of 32 bits.

        Columns: time [s], line, tool, contour error [µm], spindle speed [1/min], feed over the part
        [mm/min], tip X, Y, Z in the part's frame [mm], and the k axes' machine coordinates [mm or deg].
        """
        recording = self._scene.recording
        rows: list[list[Any]] = []
        frame = recording.header.part_frame
        for samples in recording.chunks(self._every * 16384):
            chosen = slice(self._every - 1, None, self._every)
            tools, lower = self._tools(samples)
            tips = frame.position(samples.real(frame), lower)
            setpoint = samples.setpoint
            rows.append(
                [column[chosen] for column in (setpoint.time, setpoint.line, tools)]
                + [self._spindle_speeds(setpoint.move[chosen])]
                + [column[chosen] for column in (*tips.T, *samples.joint_position.T)]
            )
        columns = [np.concatenate(parts) for parts in zip(*rows, strict=True)]
        columns.insert(3, self._errors(len(columns[0])))
        columns.insert(5, _feeds(columns[0], columns[2], np.array(columns[5:8])))
        head = struct.pack("<II", len(columns[0]), len(recording.header.axes))
        return head + b"".join(column.astype("<f4").tobytes() for column in columns)

    def _spindle_speeds(self, moves: IntArray) -> FloatArray:
        """Speed of the spindle in moves [1/min]; 0 where nothing is known of it."""
        known, place = np.unique(moves, return_inverse=True)
        speeds = [self._scene.summary.spindle.at(int(move)) or 0.0 for move in known]
        return np.array(speeds)[place]

    def _tools(self, samples: Samples) -> tuple[IntArray, FloatArray]:
        """Number of the tool of each sample, and how much longer it is than the first [mm]."""
        plan, move = self._scene.summary.tools, samples.setpoint.move
        numbers = np.zeros(len(samples), np.int64)
        for run, tool in plan.runs(move):
            numbers[run] = tool.number
        return numbers, plan.lower(move)

    def _errors(self, count: int) -> FloatArray:
        """The greatest contour error of each group of samples [µm]; 0 where it is not known."""
        recording = self._scene.recording
        errors = recording.contour_um(0, count * self._every)
        if errors is None:
            return np.zeros(count)
        return errors.reshape(count, self._every).max(axis=1)

    def stock_grid(self) -> dict[str, object] | None:
        """The grid of the stock; None where there is none."""
        cutter = self._cutter()
        return None if cutter is None else grid_of(cutter.map)

    def cuts(self) -> Iterator[bytes]:
        """The stock as it was cut: length, time [s], patch or mesh; the first is the blank."""
        if self.has_part_mesh:
            yield from self._meshes()
            return
        cutter, recording = self._cutter(), self._scene.recording
        if cutter is None:
            return
        shape = cutter.map.heights.shape
        yield _timed(0.0, patch_message(cutter.map, (0, shape[0], 0, shape[1])))
        by = np.zeros(shape, np.uint8)
        for chunk in recording.chunks(max(1, -(-len(recording) // CUTS))):
            tools, _ = self._tools(chunk)
            ends = [*np.flatnonzero(np.diff(tools)) + 1, len(chunk)]
            for begin, end in itertools.pairwise([0, *ends]):
                samples, before = chunk[begin:end], cutter.map.heights.copy()
                cutter.add(samples, self._scene.summary.is_rapid(samples.setpoint.move))
                if cutter.changed[0] < cutter.changed[1]:
                    by[cutter.map.heights < before] = tools[begin]
                    patch = patch_message(cutter.map, cutter.changed, tools=by)
                    yield _timed(float(samples.setpoint.time[-1]), patch)

    def _cutter(self) -> Cutter | None:
        header, stock = self._scene.recording.header, self._scene.stock
        if stock is None or self._scene.summary.tilts:
            return None
        return Cutter(stock, self._scene.summary.tools, header.part_frame, header.part_zero)

    @property
    def has_part_mesh(self) -> bool:
        """Whether the part is cut from several sides: it is drawn as a mesh, that has no grid."""
        return self._scene.stock is not None and self._scene.summary.tilts

    def _meshes(self) -> Iterator[bytes]:
        """The part at some moments of the run, and when it is finished."""
        scene, header = self._scene, self._scene.recording.header
        assert scene.stock is not None
        cutter = Cutter(
            scene.stock, scene.summary.tools, header.part_frame, header.part_zero, tilts=True
        )
        material = cutter.material
        assert isinstance(material, TriDexelMaterial)
        yield _timed(0.0, mesh_message(material.stock, CROSSINGS))
        finished = 0.0
        for chunk in scene.recording.chunks(max(1, -(-len(scene.recording) // MESHES))):
            cutter.add(chunk, scene.summary.is_rapid(chunk.setpoint.move))
            if material.changed:
                finished = float(chunk.setpoint.time[-1])
                yield _timed(finished, mesh_message(material.stock, CROSSINGS))
        yield _timed(finished, mesh_message(material.stock, LAST_CROSSINGS))

    def drawn(self, number: int) -> DrawnMachine | None:
        """The machine with one of the run's tools; None where there is no such tool."""
        header = self._scene.recording.header
        for tool in self._scene.summary.tools.tools:
            if tool.number == number:
                return drawn_machine(
                    self._machine,
                    tool,
                    header.part_frame,
                    self._scene.stock,
                    header.part_zero,
                )
        return None


def _feeds(time: FloatArray, tool: IntArray, tips: FloatArray) -> FloatArray:
    """How fast the tip goes over the part [mm/min]; tips of shape (3, n) [mm]."""
    distance = np.linalg.norm(np.diff(tips, prepend=tips[:, :1]), axis=0)
    # Another tool's tip is elsewhere at once.
    distance[tool != np.append(tool[:1], tool[:-1])] = 0.0
    step = np.diff(time, prepend=time[:1])
    return SECONDS_PER_MINUTE * np.divide(
        distance, step, out=np.zeros_like(distance), where=step > 0
    )


def _timed(time_s: float, patch: bytes) -> bytes:
    return struct.pack("<If", len(patch), time_s) + patch
